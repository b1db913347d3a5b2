"""What training does to a clip before it sees it: mirror image, crop, speed, choice of caption."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from motionrt.motion.features import guo263
from motionrt_training.packed import GUO263_RATES, PackedClip, PackedCorpus


@dataclass(frozen=True)
class View:
    """One look at a clip: mirrored or not, which source frames at which speed, which caption."""

    mirror: bool
    first: float  # source frame of the first frame
    speed: float  # source frames per frame
    frames: int
    caption: int
    window: int | None = None  # of the clip's windows: its slots, and its own texts where it has some


@dataclass(frozen=True)
class Augmentation:
    """How far a view may differ from its clip; lengths in frames at 20 fps."""

    mirror: bool = True
    crop: float = 0.6  # least part of the clip that is kept
    least: int = 20
    most: int = 200
    speed: float = 0.1  # speed changes by up to this fraction
    spoken: float = 0.25  # part of the views that take a window with texts of its own, where clips have windows


def draw_view(clip: PackedClip, rules: Augmentation, rng: np.random.Generator) -> View:
    """A random view of a clip."""
    mirror = rules.mirror and bool(rng.random() < 0.5)
    speed = float(np.exp(rng.uniform(-1.0, 1.0) * np.log1p(rules.speed)))
    if clip.windows:
        return _window_view(clip, rules, mirror, speed, rng)
    available = max(1, int((clip.length - 1) / speed) + 1)
    longest = min(available, rules.most)
    shortest = min(longest, max(rules.least, int(np.ceil(rules.crop * available))))
    frames = int(rng.integers(shortest, longest + 1))
    first = rng.uniform(0.0, max(0.0, clip.length - 1 - (frames - 1) * speed))
    first = first if rules.speed else float(round(first))
    return View(mirror, first, speed, frames, int(rng.integers(len(clip.texts))))


def _window_view(clip: PackedClip, rules: Augmentation, mirror: bool, speed: float, rng: np.random.Generator) -> View:
    """A view of one of the clip's windows: of those with own texts, or of those that the clip's texts describe."""
    own = [i for i, window in enumerate(clip.windows) if window.texts]
    whole = [i for i, window in enumerate(clip.windows) if not window.texts]
    number = int(rng.choice(own if own and (not whole or rng.random() < rules.spoken) else whole))
    window = clip.windows[number]
    frames = max(1, min(rules.most, int((window.frames - 1) / speed) + 1))
    return View(mirror, float(window.first), speed, frames, int(rng.integers(len(window.texts or clip.texts))), number)


def mirrored(looks: Sequence[tuple[PackedClip, View]]) -> list[tuple[PackedClip, View]]:
    """The same views in the mirror."""
    return [(clip, replace(view, mirror=not view.mirror)) for clip, view in looks]


def view_slots(clip: PackedClip, view: View) -> tuple[int, ...]:
    """The measured slots of what a view shows; () where the corpus was packed without windows."""
    if view.window is None:
        return ()
    window = clip.windows[view.window]
    return window.slots_mirror if view.mirror else window.slots


def view_motion(corpus: PackedCorpus, clip: PackedClip, view: View) -> NDArray[np.float32]:
    """The frames of a view (frames, D), float32: linear between neighbours, rates scaled by the speed.

    Exact for speed 1; otherwise good to the size of a frame's change.
    """
    source = corpus.motion(clip, mirror=view.mirror)
    if view.speed == 1.0 and view.first == round(view.first):
        return source[int(view.first) : int(view.first) + view.frames].astype(np.float32)
    at = np.minimum(view.first + view.speed * np.arange(view.frames), len(source) - 1)
    low = np.minimum(at.astype(np.int64), max(0, len(source) - 2))
    high = np.minimum(low + 1, len(source) - 1)
    part = (at - low).astype(np.float32)[:, None]
    motion = source[low].astype(np.float32)
    motion += part * (source[high].astype(np.float32) - motion)
    if motion.shape[1] > GUO263_RATES[-1]:
        motion[:, GUO263_RATES] *= np.float32(view.speed)
    return motion


def straightened(motion: NDArray[np.float32]) -> NDArray[np.float32]:
    """`guo263` frames (F, 263) without their turn: the yaw rate is zero, all else is seen from the heading anyway."""
    straight = motion.copy()
    straight[:, guo263.YAW_STEP] = 0.0
    return straight


def view_text(clip: PackedClip, view: View) -> str:
    """The caption of a view: a mirrored motion is spoken of with left and right swapped."""
    window = clip.windows[view.window] if view.window is not None else None
    part = window if window and window.texts else clip
    return (part.texts_mirror if view.mirror else part.texts)[view.caption]
