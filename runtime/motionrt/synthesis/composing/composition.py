"""``compose``: two or more motions played at once by one body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.feet.lock import lock_feet
from motionrt.motion.motion import Motion
from motionrt.motion.transforms import floor_height
from motionrt.synthesis.composing.alignment import Align, aligned
from motionrt.synthesis.composing.blending import mixed_roots, mixed_rotations
from motionrt.synthesis.composing.layers import Derive, Layer, checked_layers
from motionrt.synthesis.composing.ownership import SEAM_JOINTS, ownership, softened
from motionrt.synthesis.composing.posture import keep_lean, on_their_ground
from motionrt.untrusted.arguments import check_flags
from motionrt.untrusted.words import shown

Keep = Literal["local", "world"]
SEAM = 1


def compose(
    layers: Sequence[Layer | Motion],
    *,
    seconds: float | None = None,
    align: Align = "start",
    seam: int = SEAM,
    keep: Keep = "local",
    foot_lock: bool = False,
    override: bool = True,
    derive: Derive | None = None,
) -> Motion:
    """One motion out of several (SINC 3.1, for two or more, with masks).

    Layers with ``parts`` are combined by the paper's rules: whoever has fewer parts lies on top, and a leg or
    "global" takes both legs, the global orientation and the translation along. Layers with a ``mask`` lie over those
    in the order given (a later mask wins) and move the joints named, no others. The first layer may leave open what
    it moves: it then moves what the others leave. Joint rotations are copied bit for bit, except at the seam.

    Args:
        layers: two or more, in ``smpl24``; plain motions are layers without parts. Other frame rates are resampled
            to the first one's. A motion of a single frame is a pose, held as long as the others last.
        seconds: length of the result, at most 600; longer motions are cut, shorter ones looped ("stretch": all
            slower or faster). ``None`` trims to the shortest (step 1).
        align: "start", "stretch" or "phase"; see :func:`~motionrt.synthesis.composing.alignment.aligned`.
        seam: number of joints of the spine, and at most one collar, over which one layer passes into another:
            0 is the paper's hard cut, 3 uses the whole spine.
        keep: "local" copies rotations relative to the parent, as the paper does; "world" keeps what a layer has by
            itself of lean against the vertical, by turning the first joint after each seam.
        foot_lock: let standing feet stand (:func:`~motionrt.motion.feet.lock.lock_feet`); changes the legs.
        override: combine actions that need the same parts, and masks that overlap, as at test time in the paper.
        derive: finds the parts of layers that have none; for example by the speeds of the joints.

    Returns:
        A Motion at the first layer's frame rate. Where legs do not come from the same layer as the pelvis, its height
        follows the feet.

    Raises:
        InvalidInputError: fewer than two layers, another skeleton, an unknown option, a layer that does not say what
            it moves and no ``derive``, lengths out of range, or clashing layers without ``override``.
    """
    _check(seam, keep)
    check_flags(foot_lock=foot_lock, override=override)
    checked = checked_layers(layers)
    shares = ownership(checked, derive=derive, override=override)
    motions = aligned([layer.motion for layer in checked], int(np.argmax(shares[:, 0])), align, seconds)
    soft = softened(shares, seam)
    rotations = mixed_rotations([motion.rotations for motion in motions], soft)
    if keep == "world":
        rotations = keep_lean(rotations, motions, soft)
    root = mixed_roots([motion.root for motion in motions], soft[:, 0])
    found = on_their_ground(replace(motions[0], rotations=rotations, root=root), motions, soft)
    return lock_feet(found, floor=floor_height(found)) if foot_lock else found


def _check(seam: int, keep: str) -> None:
    if isinstance(seam, bool) or not isinstance(seam, int) or not 0 <= seam <= 3:
        raise InvalidInputError(f"seam must be 0, 1, 2 or 3 joints of {', '.join(SEAM_JOINTS)}, not {seam!r}")
    if not isinstance(keep, str) or keep not in {"local", "world"}:
        raise InvalidInputError(f'keep must be "local" or "world", not {shown(keep)}')
