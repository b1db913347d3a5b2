"""The pose prior's decoder: a small normal latent -> the rotations of a plausible pose."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.sessions import Sessions
from motionrt.motion.kinematics import fk
from motionrt.motion.skeleton import SMPL24

if TYPE_CHECKING:
    from onnxruntime import SessionOptions

FloatArray = npt.NDArray[np.float32]
Decode = Callable[[FloatArray], FloatArray]

MODEL = "pose_prior"
LATENT = 32
JOINTS = 24


class PosePrior:
    """Poses of N(0, 1) latents; the pelvis' tilt is part of a pose, its yaw and position are not.

    Args:
        decode: latents ``(B, 32)`` float32 -> rotations ``(B, 24, 3, 3)`` float32; `open` gives the shipped model's.
    """

    latent = LATENT

    def __init__(self, decode: Decode) -> None:
        self._decode = decode

    @classmethod
    def open(
        cls,
        models: str | Path | Sessions | None = None,
        *,
        variant: str | None = None,
        threads: int | None = None,
        session_options: SessionOptions | None = None,
    ) -> PosePrior:
        """The prior of a manifest.

        Args:
            models: the manifest or its folder, or open `Sessions`; None takes the models that came with motionrt.
            variant: which file, e.g. ``fp32``; by default what the manifest says.
            threads: threads of the session, by default at most 2 of those that the process may use.
            session_options: options for the onnxruntime session, instead of ``threads``.

        Raises:
            ModelFileError, ManifestError: no manifest, or a bad one.
        """
        sessions = (
            models
            if isinstance(models, Sessions)
            else Sessions(models, threads=threads, session_options=session_options)
        )
        return cls(lambda rows: sessions.run(MODEL, ["rotations"], {"latent": rows}, variant)[0])

    def decode(self, latents: npt.ArrayLike) -> FloatArray:
        """Rotations ``(B, 24, 3, 3)`` float32 local to the parent, pelvis without yaw, of latents ``(B, 32)``.

        Raises:
            InvalidInputError: latents of another shape, or not finite.
        """
        rows = np.ascontiguousarray(latents, dtype=np.float32)
        if rows.ndim != 2 or rows.shape[1] != LATENT:
            raise InvalidInputError(f"expected latents (B, {LATENT}), found shape {rows.shape}")
        if not np.isfinite(rows).all():
            raise InvalidInputError("a latent holds a number that is not finite")
        return self._decode(rows) if len(rows) else np.zeros((0, JOINTS, 3, 3), np.float32)

    def sample(self, count: int, seed: int = 0) -> tuple[FloatArray, FloatArray]:
        """``count`` poses drawn from the prior: latents ``(count, 32)`` and rotations ``(count, 24, 3, 3)``."""
        latents = _drawn(count, seed)
        return latents, self.decode(latents)

    @cached_property
    def starts(self) -> tuple[FloatArray, FloatArray]:
        """256 poses that a search may begin at, made once: the mean pose and 255 drawn ones, as `sample` gives.

        Latents ``(256, 32)`` and global joint positions ``(256, 24, 3)``, metres, the pelvis at the origin.
        """
        latents = np.concatenate([np.zeros((1, LATENT), np.float32), _drawn(255, 0)])
        origin = np.zeros((len(latents), 3), np.float32)
        return latents, fk(self.decode(latents), origin, SMPL24.offsets, SMPL24.parents)[0]


def _drawn(count: int, seed: int) -> FloatArray:
    return np.random.default_rng(seed).normal(size=(count, LATENT)).astype(np.float32)
