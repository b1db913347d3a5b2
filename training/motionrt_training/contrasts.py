"""Does a caption that names a side or a turn prefer its clip to its mirror image, and to the clip without its turn?"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from motionrt.motion.features import guo263
from motionrt_training.augment import straightened
from motionrt_training.corpora.text_mirror import side_words
from motionrt_training.text_filter import names_path

Floats = NDArray[np.float32]
Mirror = Callable[[Floats], Floats]


def sided(texts: Sequence[Sequence[str]]) -> list[tuple[int, str]]:
    """(clip, caption) of every caption that has exactly one side word."""
    return [(number, text) for number, said in enumerate(texts) for text in said if len(side_words(text)) == 1]


def contrast_scores(
    texts: Sequence[Sequence[str]],
    motions: Sequence[Floats],
    embed_text: Callable[[list[str]], Floats],
    embed_motion: Callable[[list[Floats]], Floats],
    mirror: Mirror = guo263.mirror,
) -> dict[str, float]:
    """Side test and path test, percent, each with the number of its captions; {} where no caption counts.

    `side`: captions with exactly one side word, the clip against its mirror image. `path`: those of them that name a
    turn or a path, against the mirror image and the clip with its yaw rate set to zero. Ties lose.

    Args:
        texts: captions of each clip.
        motions: raw `guo263` (F, 263) at 20 fps of each clip.
        embed_text: texts into unit vectors (N, d).
        embed_motion: features into unit vectors (N, d).
        mirror: features of the mirror image.
    """
    asked = sided(texts)
    if not asked:
        return {}
    rows = np.array([number for number, _ in asked])
    clips, place = np.unique(rows, return_inverse=True)
    shown = [motions[number] for number in clips]
    text = embed_text([words for _, words in asked])
    looks = (shown, [mirror(motion) for motion in shown], [straightened(motion) for motion in shown])
    own, other, straight = ((text * embed_motion(look)[place]).sum(axis=1) for look in looks)
    path = np.array([names_path(words) for _, words in asked])
    scores = {"side": 100.0 * float((own > other).mean()), "side_captions": float(len(asked))}
    if path.any():
        scores["path"] = 100.0 * float((own > np.maximum(other, straight))[path].mean())
        scores["path_captions"] = float(path.sum())
    return scores
