"""What clients may ask for, in plain values: the runtime without a file name of this machine in sight."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from motionrt.errors import GalleryNotFoundError, InvalidInputError
from motionrt.formats import WRITABLE_SUFFIXES, load_motion
from motionrt.motion import Motion
from motionrt.retrieval import Filter, Gallery, Hit
from motionrt.runtime import Runtime
from motionrt.untrusted.files import confined
from motionrt.untrusted.words import shown

STARTER = "starter"
"""The name of the gallery that came with motionrt, where no other is served."""

FORMATS = tuple(suffix.removeprefix(".") for suffix in WRITABLE_SUFFIXES)
"""What motions are given as."""


@dataclass
class Desk:
    """The runtime, and the galleries that clients may search, by name.

    Attributes:
        runtime: whose models answer.
        galleries: name -> folder; the first is searched where none is named. Without any it is the starter gallery.
    """

    runtime: Runtime
    galleries: Mapping[str, Path | None] = field(default_factory=lambda: {STARTER: None})

    def gallery(self, name: str | None) -> Gallery:
        """The gallery of that name, as it is on disk now.

        Raises:
            GalleryNotFoundError: no such gallery is served; the message names those that are.
        """
        chosen = next(iter(self.galleries)) if name is None else name
        if chosen not in self.galleries:
            raise GalleryNotFoundError(f"no gallery {shown(chosen)} is served; there are: {', '.join(self.galleries)}")
        return self.runtime.gallery(self.galleries[chosen])

    def retrieve(
        self, text: str, k: int, gallery: str | None, *, per_clip: bool = True, anyway: bool = False,
        filters: Filter | None = None,
    ) -> dict[str, Any]:  # fmt: skip
        """Hits for a text, and what there is to say about them."""
        hits = self.runtime.retrieve(
            text, k, self.gallery(gallery), per_clip=per_clip, anyway=anyway, filter=filters or Filter()
        )
        return {"hits": [as_values(hit) for hit in hits], "notice": hits.notice}

    def similar(self, clip: str, k: int, gallery: str | None) -> dict[str, Any]:
        """The clips of a gallery most like one of its own."""
        opened = self.gallery(gallery)
        opened.motion(clip)  # there is such a clip: it is not taken for a file
        return {"hits": [as_values(hit) for hit in self.runtime.similar(clip, k, opened)], "notice": None}

    def motion(self, clip: str, start_s: float | None, end_s: float | None, gallery: str | None) -> Motion:
        """A clip of a gallery, or a part of it."""
        whole = self.gallery(gallery).motion(clip)
        if start_s is None and end_s is None:
            return whole
        first, last = start_s or 0.0, whole.duration if end_s is None else end_s
        if not 0 <= first < last or first >= whole.duration:
            raise InvalidInputError(f"{first:g} to {last:g} s is nothing of a clip of {whole.duration:.2f} s")
        return whole.between(first, last)

    def describe(self, motion: Motion, k: int) -> list[dict[str, Any]]:
        """Captions that fit a motion."""
        found = self.runtime.describe(motion, k)
        return [
            {"rank": one.rank, "score": one.score, "text": one.text, "start_s": one.start_s, "end_s": one.end_s}
            for one in found
        ]

    def compose(self, layers: Sequence[Mapping[str, Any]], seconds: float | None, seed: int | None) -> Motion:
        """One motion of several layers: each a ``text``, or a ``clip`` of a ``gallery``, and the ``parts`` it moves."""
        motions, parts = [], []
        for layer in layers:
            text, clip = layer.get("text"), layer.get("clip")
            if (text is None) == (clip is None):
                raise InvalidInputError("a layer is a text or a clip, one of them")
            given = layer.get("parts")
            if text is not None:
                motions.append(self.runtime.generate(text, seed=seed))
                parts.append(sorted(self.runtime.body_parts(text)) if given is None else given)
            else:
                motions.append(self.motion(str(clip), None, None, layer.get("gallery")))
                parts.append(given)
        return self.runtime.compose(motions, parts, seconds=seconds, seed=seed)


def as_values(hit: Hit) -> dict[str, Any]:
    """A hit without the path of its file."""
    return {
        "rank": hit.rank,
        "score": hit.score,
        "clip": hit.id,
        "start_s": hit.start_s,
        "end_s": hit.end_s,
        "text": hit.text,
        "cosine": hit.cosine,
        "agreement": hit.agreement,
    }


def read_motion(name: str, content: bytes) -> Motion:
    """A motion out of the bytes of a file; ``name`` says the format, and the file may name no other.

    Raises:
        FormatError, RigError, InvalidInputError: it cannot be read.
    """
    with tempfile.TemporaryDirectory(prefix="motionrt-") as place:
        path = Path(place) / f"motion{Path(name).suffix.lower()[:8]}"
        path.write_bytes(content)
        with confined(Path(place)):
            return load_motion(path)


def written(motion: Motion, form: str) -> bytes:
    """A motion as the bytes of a file; InvalidInputError for a format that is not written."""
    if form not in FORMATS:
        raise InvalidInputError(f"a motion is given as {', '.join(FORMATS)}, not {shown(form)}")
    with tempfile.TemporaryDirectory(prefix="motionrt-") as place:
        return motion.save(Path(place) / f"motion.{form}").read_bytes()
