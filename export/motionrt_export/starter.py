"""The starter gallery under new models: its own motions, embedded again."""

from __future__ import annotations

from pathlib import Path

from motionrt import Gallery, Runtime


def embed_starter(runtime: Runtime, folder: str | Path) -> Gallery:
    """Embed the motions that the gallery in ``folder`` carries with the models of ``runtime``, in place.

    ``python -m motionrt_training.recipes.starter`` makes the motions themselves.
    """
    gallery = Gallery.open(folder)
    ids = [clip.id for clip in gallery.clips]
    texts = [clip.text or clip.id for clip in gallery.clips]
    motions = [gallery.motion(name) for name in ids]
    return Gallery.from_motions(motions, ids, runtime.model, texts=texts).save(folder)
