"""Clips of two stretches one after the other, with captions that say so: "A, then B"."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionrt_training.corpora.text_mirror import mirror_text
from motionrt_training.wording.saying import THEN

LONGEST = 100  # frames of each part at 20 fps
Row = tuple[NDArray[np.float16], dict[str, Any]]


def joined_clips(rows: list[Row], count: int, rng: np.random.Generator) -> list[Row]:
    """`count` clips of two of `rows` each; features are local in time, so that they can stand beside each other."""
    if len(rows) < 2:
        return []
    return [_joined(rows, number, rng) for number in range(count)]


def _joined(rows: list[Row], number: int, rng: np.random.Generator) -> Row:
    parts = [rows[int(i)] for i in rng.choice(len(rows), size=2, replace=False)]
    texts = [_both([meta for _, meta in parts], rng) for _ in range(3)]
    joined = np.concatenate([features[:LONGEST] for features, _ in parts])
    meta = {
        "id": f"joined-{number}", "split": "train", "group": f"joined-{number}", "source": "",
        "texts": texts, "texts_mirror": [mirror_text(text) for text in texts],
        "windows": [[0, len(joined), [], [], [], []]],
    }  # fmt: skip
    return joined, meta


def _both(metas: list[dict[str, Any]], rng: np.random.Generator) -> str:
    first, second = (str(rng.choice(sorted(meta["texts"], key=len)[:3])).rstrip(".") for meta in metas)
    return f"{first}{rng.choice(THEN)}{second[:1].lower()}{second[1:]}"
