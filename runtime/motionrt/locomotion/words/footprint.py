"""The ground plan of a thing: the smallest rectangle around it, and that rectangle's four sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Plan = npt.NDArray[np.float64]  # (2,) or (N, 2): x and z, metres

_EDGE = 1.0  # per cent of the points that may stick out of the rectangle at each side


@dataclass(frozen=True, eq=False)
class Side:
    """One side of a ground plan.

    Attributes:
        normal: unit ``(2,)`` out of the thing.
        along: unit ``(2,)``, a quarter turn from it: what somebody who faces the thing has on the left.
        centre: ``(2,)`` the middle of the side.
        width, depth: metres along the side, and from it to the opposite one.
    """

    normal: Plan
    along: Plan
    centre: Plan
    width: float
    depth: float

    def inside(self, points: npt.NDArray[np.floating]) -> Plan:
        """How far points ``(N, 3)`` lie behind this side ``(N,)``, metres."""
        return np.asarray((self.centre - plan(points)) @ self.normal)

    def across(self, points: npt.NDArray[np.floating]) -> Plan:
        """Where points ``(N, 3)`` lie along this side ``(N,)``, metres from its middle."""
        return np.asarray((plan(points) - self.centre) @ self.along)

    def at(self, across: float, outside: float) -> Plan:
        """The place ``(2,)`` that far along the side and in front of it."""
        return np.asarray(self.centre + across * self.along + outside * self.normal)

    @property
    def heading_out(self) -> float:
        """Yaw of somebody with the thing behind."""
        return float(np.arctan2(self.normal[0], self.normal[1]))

    @property
    def heading_in(self) -> float:
        """Yaw of somebody who faces the thing."""
        return float(np.arctan2(-self.normal[0], -self.normal[1]))


def plan(points: npt.NDArray[np.floating]) -> Plan:
    """The ground plan ``(N, 2)``, x and z, of points ``(N, 3)``."""
    return np.asarray(points[:, [0, 2]], dtype=np.float64)


def sides(points: npt.NDArray[np.floating]) -> tuple[Side, Side, Side, Side]:
    """The sides of the smallest rectangle around points ``(N, 3)``; opposite ones are two apart."""
    ground = plan(points)
    angle = _smallest(ground, np.deg2rad(np.arange(0.0, 90.0, 3.0)))
    angle = _smallest(ground, angle + np.deg2rad(np.arange(-2.75, 3.0, 0.25)))
    axes = _axes(angle)
    low, high = _extent(ground, axes)
    middle, size = axes.T @ ((low + high) / 2), high - low
    return (
        _side(axes[0], middle, size[0], size[1]),
        _side(axes[1], middle, size[1], size[0]),
        _side(-axes[0], middle, size[0], size[1]),
        _side(-axes[1], middle, size[1], size[0]),
    )


def _side(normal: Plan, middle: Plan, depth: float, width: float) -> Side:
    # who faces along -normal in the plane (x, z) has the direction (-normal_z, normal_x) on the left
    along = np.array([-normal[1], normal[0]])
    return Side(normal, along, middle + normal * depth / 2, float(width), float(depth))


def _axes(angle: float) -> Plan:
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def _extent(ground: Plan, axes: Plan) -> tuple[Plan, Plan]:
    low, high = np.percentile(ground @ axes.T, [_EDGE, 100.0 - _EDGE], axis=0)
    return low, high


def _smallest(ground: Plan, angles: Plan) -> float:
    """The angle of the rectangle with the smallest area (perimeter, where the area vanishes)."""
    extents = [np.subtract(*_extent(ground, _axes(angle))[::-1]) for angle in angles]
    return float(angles[int(np.argmin([size.prod() + 0.01 * size.sum() for size in extents]))])
