"""Rigs as ASF and AMC files, written from scratch with SciPy: no code under test in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from motionrt.rigs import RigClip


@dataclass(frozen=True)
class Acclaim:
    """How a rig is written.

    Attributes:
        length: the number behind ``length`` among the units; it makes a unit 0.0254 m over that number.
        degrees: whether angles are degrees.
        dof: order of the degrees of freedom of all bones.
        axis: of all bones, degrees.
    """

    length: float = 1.0
    degrees: bool = True
    dof: str = "xyz"
    axis: Sequence[float] = (0, 0, 0)

    def write(self, clip: RigClip, stem: Path) -> Path:
        """``clip``, in metres and without rotations at rest, as ``stem.amc`` and ``stem.asf``; returns the former."""
        stem.with_suffix(".asf").write_text("\n".join(self._skeleton(clip)), encoding="utf-8")
        stem.with_suffix(".amc").write_text("\n".join(self._frames(clip)), encoding="utf-8")
        return stem.with_suffix(".amc")

    @property
    def unit(self) -> float:
        """Metres."""
        return 0.0254 / self.length

    def _skeleton(self, clip: RigClip) -> list[str]:
        bones = _Bones(self, clip)
        bones.grow(clip.parents.index(-1), "")
        angle = "deg" if self.degrees else "rad"
        lines = [
            ":version 1.10",
            ":name somebody",
            ":units",
            "  mass 1.0",
            f"  length {self.length}",
            f"  angle {angle}",
        ]
        lines += [":root", "  order TX TY TZ RX RY RZ", "  axis XYZ", "  position 0 0 0", "  orientation 0 0 0"]
        return [*lines, ":bonedata", *bones.lines, ":hierarchy", "  begin", *bones.links, "  end", ""]

    def _frames(self, clip: RigClip) -> list[str]:
        number = 1.0 if self.degrees else np.pi / 180
        frame = Rotation.from_euler("xyz", self.axis, degrees=True)
        root, columns = clip.parents.index(-1), {}
        for joint, name in enumerate(clip.names):
            turn = Rotation.from_matrix(clip.rotations[:, joint].astype(float))
            if joint == root:
                places = clip.translations[:, joint] / self.unit
                columns["root"] = np.concatenate([places, number * turn.as_euler("xyz", degrees=True)], axis=1)
            else:
                columns[name] = number * (frame.inv() * turn * frame).as_euler(self.dof, degrees=True)
        kind = ":DEGREES" if self.degrees else ":RADIANS"
        lines = ["#!OML:ASF", ":FULLY-SPECIFIED", kind, f":SAMPLES-PER-SECOND {clip.fps:g}"]
        for step in range(clip.frames):
            lines.append(str(step + 1))
            lines += [f"{name} " + " ".join(f"{v:.6f}" for v in values[step]) for name, values in columns.items()]
        return [*lines, ""]


@dataclass
class _Bones:
    """A joint's bone leads to its first child; those to the others, and away from the root, do not turn."""

    how: Acclaim
    clip: RigClip
    lines: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)

    def grow(self, joint: int, above: str) -> None:
        """The bones of a joint and of all below it, on the bone ``above``; without one it is the root."""
        children = [other for other, parent in enumerate(self.clip.parents) if parent == joint]
        name, end = self.clip.names[joint] if above else "root", np.zeros(3)
        if above:
            end = (self.clip.offsets[children[0]] if children else self.clip.offsets[joint] / 2).astype(float)
            self._bone(name, above, end, turns=True)
        for child in children:
            if above and child == children[0]:
                self.grow(child, name)
            else:
                link = f"{self.clip.names[child]}joint"
                self._bone(link, name, self.clip.offsets[child].astype(float) - end, turns=False)
                self.grow(child, link)

    def _bone(self, name: str, above: str, way: np.ndarray, *, turns: bool) -> None:
        size = float(np.linalg.norm(way))
        way = way / size if size else np.array([0.0, 1.0, 0.0])
        told = self.how.axis if self.how.degrees else np.radians(self.how.axis)
        self.links.append(f"    {above} {name}")
        self.lines += ["  begin", f"    id {len(self.links)}", f"    name {name}"]
        self.lines.append("    direction " + " ".join(f"{value:.8f}" for value in way))
        self.lines.append(f"    length {size / self.how.unit:.6f}")
        self.lines.append("    axis " + " ".join(f"{value:.6f}" for value in told) + " XYZ")
        self.lines += ["    dof " + " ".join(f"r{letter}" for letter in self.how.dof)] if turns else []
        self.lines.append("  end")
