"""Rooms made of boxes, as labelled points on their surfaces, with sizes that tests know."""

from __future__ import annotations

import numpy as np

from motionrt.locomotion.words import SemanticCloud

Box = tuple[tuple[float, float, float], tuple[float, float, float]]  # lowest and highest corner, metres


def surface(box: Box, step: float = 0.04) -> np.ndarray:
    """Points on all six faces."""
    low, high = np.array(box[0]), np.array(box[1])
    faces = []
    for axis in range(3):
        u, v = [a for a in range(3) if a != axis]
        grid = np.stack(np.meshgrid(*(_line(low[a], high[a], step) for a in (u, v))), -1).reshape(-1, 2)
        for value in (low[axis], high[axis]):
            face = np.empty((len(grid), 3))
            face[:, axis], face[:, [u, v]] = value, grid
            faces.append(face)
    return np.concatenate(faces)


def sofa(x: float = 0.0, z: float = 0.0) -> list[Box]:
    """1.8 m wide, seat 0.45 m high from z to z + 0.6, backrest behind it up to 0.85 m, armrests of 0.6 m; faces +Z."""
    return [
        ((x - 0.7, 0.0, z), (x + 0.7, 0.45, z + 0.6)),
        ((x - 0.9, 0.0, z - 0.2), (x + 0.9, 0.85, z)),
        ((x - 0.9, 0.0, z), (x - 0.7, 0.60, z + 0.6)),
        ((x + 0.7, 0.0, z), (x + 0.9, 0.60, z + 0.6)),
    ]


def shelf(x: float = 0.0, z: float = 0.0) -> list[Box]:
    """1 m wide, 0.3 m deep (z to z + 0.3), boards at every 0.4 m up to 2 m, a closed back at z."""
    boards: list[Box] = [((x - 0.5, y, z), (x + 0.5, y + 0.02, z + 0.3)) for y in (0.0, 0.4, 0.8, 1.2, 1.6, 2.0)]
    return [*boards, ((x - 0.5, 0.0, z), (x + 0.5, 2.0, z + 0.02))]


def room(things: dict[str, list[Box]], turn: float = 0.0, at: tuple[float, float, float] = (0, 0, 0)) -> SemanticCloud:
    """Things in a room with a floor from -3 to 3 m, as a whole turned about Y by ``turn`` and moved to ``at``."""
    parts = {name: np.concatenate([surface(box) for box in boxes]) for name, boxes in things.items()}
    grid = np.stack(np.meshgrid(np.arange(-3, 3.01, 0.1), np.arange(-3, 3.01, 0.1)), -1).reshape(-1, 2)
    parts["floor"] = np.stack([grid[:, 0], np.zeros(len(grid)), grid[:, 1]], axis=1)
    labels = np.concatenate([[name] * len(points) for name, points in parts.items()])
    points = np.concatenate(list(parts.values()))
    return SemanticCloud(points @ turn_matrix(turn).T + np.array(at), labels)


def turn_matrix(turn: float) -> np.ndarray:
    """Turns +Z towards +X."""
    return np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])


def _line(low: float, high: float, step: float) -> np.ndarray:
    return np.linspace(low, high, max(2, round((high - low) / step) + 1))
