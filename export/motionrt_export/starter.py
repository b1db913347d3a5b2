"""The starter gallery: motions that the shipped decoder makes of prompts written for it. No recorded clip is in it.

Each line of ``starter_prompts.txt`` is ``seconds | prompt``. The same models give the same gallery.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from motionrt import Gallery, Runtime
from motionrt.models import TextMotionModel
from motionrt.motion import Motion
from motionrt.motion.features import guo263

PROMPTS = Path(__file__).with_name("starter_prompts.txt")


def build_starter(runtime: Runtime, folder: str | Path) -> Gallery:
    """Decode every prompt, index the motions and write the gallery (and its motions) to ``folder``."""
    prompts = list(read_prompts(PROMPTS))
    motions = [decode_prompt(runtime.model, text, seconds) for seconds, text in prompts]
    texts = [text for _, text in prompts]
    return Gallery.from_motions(motions, [_name(text) for text in texts], runtime.model, texts=texts).save(folder)


def decode_prompt(model: TextMotionModel, text: str, seconds: float) -> Motion:
    """The motion at 20 fps that the decoder makes of the text's latent, feet on the floor."""
    features = model.decode(model.text_latents([text]), round(seconds * guo263.FPS))[0]
    return guo263.decode(features)


def read_prompts(path: Path) -> Iterator[tuple[float, str]]:
    """(seconds, prompt) of every line that is neither empty nor a comment."""
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.strip() and not line.startswith("#"):
            seconds, _, text = line.partition("|")
            yield float(seconds), text.strip()


def _name(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
