"""What a character did: its motion, its parts, and how well each was done."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path as FilePath

import numpy as np

from motionrt.locomotion.clearing import clear_forearms, in_reach
from motionrt.locomotion.held_points import hold_points
from motionrt.locomotion.path import Path
from motionrt.locomotion.terrain import Heights, Terrain, on_plane, raised, smoothed
from motionrt.locomotion.uneven import feet_on_ground
from motionrt.metrics.locomotion import end_error, path_distances
from motionrt.metrics.penetration import Surfaces, penetration
from motionrt.metrics.walk_report import LocomotionMeasures
from motionrt.motion import SMPL24, Motion
from motionrt.motion.feet.lock import lock_feet, planted_toes
from motionrt.motion.skeleton import FloatArray


@dataclass(frozen=True)
class Segment:
    """A part of a performance.

    Attributes:
        kind: ``walk``, ``transition``, ``hold`` or ``generated``.
        name: the action that it belongs to.
        start, end: frames, ``end`` exclusive.
        keypoints: of a pose that is held, where joints should be, metres.
        miss_cm: by how much each is missed in the motion, in the middle of the hold.
        end_cm: of a transition, mean distance of the joints in its last frame from the pose that it should end in.
        off_path_m: of a walk, mean distance from its path.
    """

    kind: str
    name: str
    start: int
    end: int
    keypoints: Mapping[str, Sequence[float]] = field(default_factory=dict)
    miss_cm: Mapping[str, float] = field(default_factory=dict)
    end_cm: float | None = None
    off_path_m: float | None = None

    @property
    def frames(self) -> int:
        """Number of frames."""
        return self.end - self.start


Aim = Path | Motion | None
"""What a segment should do: the path of a walk, the last pose of a transition."""


@dataclass(frozen=True)
class PerformanceMeasures:
    """Figures of a whole performance; ``None`` where there is nothing to measure.

    Attributes:
        motion: of all frames together.
        off_path_m: mean distance of the root from the paths, over the frames that walk them.
        keypoint_cm: mean distance of the keypoints from their joints.
        keypoint_max_cm: the largest.
        transition_end_cm: mean distance of the joints at the ends of transitions from the poses aimed at.
        largest_step_cm: the farthest that the root moves from one frame to the next.
        penetration_share: share of the frames in which a limb is inside a surface of the cloud by more than 1 cm; see
            :func:`motionrt.metrics.penetration`.
        penetration_cm: how deep, mean of those frames.
        penetration_max_cm: the deepest.
    """

    motion: LocomotionMeasures
    off_path_m: float | None
    keypoint_cm: float | None
    keypoint_max_cm: float | None
    transition_end_cm: float | None
    largest_step_cm: float
    penetration_share: float | None = None
    penetration_cm: float | None = None
    penetration_max_cm: float | None = None

    def as_dict(self) -> dict[str, float | int | None]:
        """Plain numbers by name, for JSON."""
        own = {name: getattr(self, name) for name in self.__dataclass_fields__ if name != "motion"}
        along = ("path_deviation", "goal_", "waypoint")  # the paths of several walks are not one path
        return {k: v for k, v in self.motion.as_dict().items() if not k.startswith(along)} | own


@dataclass(frozen=True, eq=False, repr=False)
class Performance:
    """What a character did.

    Attributes:
        motion: all frames, 30 fps, in the world.
        segments: its parts in order, without gaps.
        paths: the paths that were walked.
        ground: ``(F,)`` metres, height of the ground under the character.
        surfaces: ``(N, 3)`` points of what is not the ground, metres, where a cloud was given.
    """

    motion: Motion
    segments: tuple[Segment, ...]
    paths: tuple[Path, ...]
    ground: Heights
    surfaces: FloatArray | None = None

    def __repr__(self) -> str:
        return f"Performance({len(self.segments)} segments, {self.motion.duration:.2f} s)"

    def _repr_html_(self) -> str:
        """Measures and a strip of poses, for notebooks."""
        from motionrt.metrics.labelled import HEADER, labelled
        from motionrt.motion.notebook import page, strip, table

        return page(repr(self), strip(self.motion), table(HEADER, labelled(self.measures.as_dict())))

    @cached_property
    def measures(self) -> PerformanceMeasures:
        """How well it was done."""
        steps = np.linalg.norm(np.diff(self.motion.root, axis=0), axis=1)
        misses = [miss for segment in self.segments for miss in segment.miss_cm.values()]
        inside = None if self.surfaces is None else penetration(self.motion.positions(), self.surfaces)
        return PerformanceMeasures(
            motion=LocomotionMeasures.of(on_plane(self.motion.positions(), self.ground), self.motion.fps),
            off_path_m=_mean([s.off_path_m for s in self.segments], [s.frames for s in self.segments]),
            keypoint_cm=float(np.mean(misses)) if misses else None,
            keypoint_max_cm=max(misses, default=None),
            transition_end_cm=_mean([s.end_cm for s in self.segments]),
            largest_step_cm=float(100 * steps.max(initial=0.0)),
            penetration_share=None if inside is None else inside.share,
            penetration_cm=None if inside is None else inside.mean_cm,
            penetration_max_cm=None if inside is None else inside.max_cm,
        )

    def save(self, path: str | FilePath) -> FilePath:
        """Write the motion (.bvh, .glb, .npz); returns the path."""
        return self.motion.save(path)


def performance_of(
    motion: Motion,
    segments: Sequence[Segment],
    aims: Sequence[Aim],
    ground: Heights,
    *,
    terrain: Terrain | None = None,
    surfaces: FloatArray | None = None,
    foot_lock: bool = True,
) -> Performance:
    """Clean up feet and held keypoints if asked to, raise all to the ``(F,)`` heights of the ground, and measure.

    Where a terrain is given, each foot stands on the ground under itself.
    """
    plane = lock_feet(motion) if foot_lock else motion
    ground = smoothed(ground)
    holds = [(each.start, each.end, each.keypoints) for each in segments if each.kind == "hold"]
    motion = raised(plane, ground)
    under = None if terrain is None else terrain.heights
    if foot_lock and under is not None:
        motion = feet_on_ground(motion, planted_toes(plane), ground, under)
    motion = hold_points(motion, holds) if foot_lock else motion
    near = None if surfaces is None else in_reach(motion, surfaces)
    if near is not None and len(near):
        motion = clear_forearms(motion, Surfaces(near), holds)
    pairs = zip(segments, aims, strict=True)
    measured = tuple(_measured(plane if isinstance(aim, Motion) else motion, segment, aim) for segment, aim in pairs)
    return Performance(motion, measured, tuple(aim for aim in aims if isinstance(aim, Path)), ground, surfaces)


def _measured(motion: Motion, segment: Segment, aim: Aim) -> Segment:
    if isinstance(aim, Path):
        ground = motion.root[segment.start : segment.end, [0, 2]]
        return replace(segment, off_path_m=float(path_distances(ground, aim.points).mean()))
    if isinstance(aim, Motion):
        last = motion[segment.end - 1 : segment.end].positions()[0]
        return replace(segment, end_cm=end_error(last, aim.positions()[-1]).joints_cm)
    return replace(segment, miss_cm=_misses(motion, segment))


def _misses(motion: Motion, segment: Segment) -> dict[str, float]:
    middle = (segment.start + segment.end) // 2
    joints = motion[middle : middle + 1].positions()[0]
    return {
        name: float(100 * np.linalg.norm(joints[SMPL24.index(name)] - np.asarray(point)))
        for name, point in segment.keypoints.items()
    }


def _mean(values: Sequence[float | None], weights: Sequence[int] | None = None) -> float | None:
    """Mean of what is known."""
    pairs = zip(values, weights or [1] * len(values), strict=True)
    known = [(value, weight) for value, weight in pairs if value is not None]
    total = sum(weight for _, weight in known)
    return sum(value * weight for value, weight in known) / total if known else None
