"""Test vectors in JSON and .npy, with which a port in any language checks itself; they belong to one set of models.

| file | |
|---|---|
| `vectors.json` | sha256 of the models; texts with token ids; goals of the walk; texts and seeds of the motions |
| `embeddings.npy` | `(N, 256)` of the first N texts, by `tmr_text` |
| `walk_history.npy`, `walk_frames.npy` | `(30, 219)` before and `(600, 219)` of the walk, in the world |
| `motion_K_features.npy`, `_noise.npy`, `_rows.npy` | tokens `(T, 384)`, noise `(F, 77)`, the motion `(G, 99)` |

Rows of a motion are the pelvis in metres and 24 quaternions wxyz, at 30 fps. All are made with the portable files:
float arithmetic gives the same everywhere within 1e-3 after 600 frames, quantised arithmetic drifts apart.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import onnxruntime as ort

from motionrt.errors import InvalidInputError
from motionrt.locomotion.crowd import SPEED, Crowd, history_of
from motionrt.locomotion.starting_poses import stride
from motionrt.models import Sessions, TextMotionModel
from motionrt.models.text import SentenceEncoder, load_tokenizer
from motionrt.models.walknet import WalkModel
from motionrt.motion.features import ego77
from motionrt.retrieval.captions import read_captions
from motionrt.services.search import DEFAULT_CAPTIONS
from motionrt.synthesis.motion_generator import MotionGenerator, Wanted
from motionrt.synthesis.sampling import Sampling
from motionrt.synthesis.timeline import Line
from motionrt.web.folder import motion_rows

MODELS = ("tmr_text", "walknet", "motion_denoiser")
GOALS = ((0, (2.0, 6.0, 0.4)), (220, (-5.0, 9.0, -1.2)), (420, (-9.0, 2.0, -2.4)))
"""From which frame on the walk goes where: x, z, heading."""
FRAMES = 600
MOTIONS = (("a person waves with the right hand", 3.0, 1), ("walks in a circle to the left", 5.0, 7))
EMBEDDED = 16
_LETTERS = (
    *("é", "İ", "ß", "Σ", "ς", "ﬁ", "Ǆ", "①", "ʼ", "中", "한", "😀", "–", "’", "[CLS]", "[mask]", "\x00", "\t"),
    *("\u00a0", "\u0301", "\u200b", "\u2028", "\ufffd", "\ufffe", "\U000163be"),
)


class FloatSessions(Sessions):
    """The models of `motionrt_export.portable` where there is a file of one, the shipped ones otherwise."""

    def __init__(self, folder: Path) -> None:
        super().__init__(threads=1)
        self._folder, self._float = folder, dict[str, ort.InferenceSession]()
        self._options = ort.SessionOptions()
        self._options.intra_op_num_threads = 1

    def run(
        self, model: str, outputs: Sequence[str], feeds: Mapping[str, npt.NDArray[Any]], variant: str | None = None
    ) -> Any:
        """As of Sessions; inputs that the portable file has not are left out."""
        path = self._folder / f"{model}.portable.onnx"
        if not path.is_file():
            return super().run(model, list(outputs), dict(feeds), variant)
        session = self._float.get(model)
        if session is None:
            session = self._float[model] = ort.InferenceSession(path, self._options, ["CPUExecutionProvider"])
        known = {value.name for value in session.get_inputs()}
        return session.run(list(outputs), {name: value for name, value in feeds.items() if name in known})


def texts(count: int, seed: int = 5) -> list[str]:
    """Captions as they are, with foreign letters in them, strung together, and strings of any characters."""
    random, captions = np.random.default_rng(seed), read_captions(DEFAULT_CAPTIONS)

    def caption() -> str:
        return str(captions[random.integers(len(captions))])

    def spoilt() -> str:
        text = caption()
        for _ in range(3):
            place = int(random.integers(len(text) + 1))
            text = text[:place] + _LETTERS[random.integers(len(_LETTERS))] + text[place:]
        return text

    def anything() -> str:
        blocks = ((32, 127), (0, 0x250), (0x250, 0x3000), (0x3000, 0xD800), (0xE000, 0x10000), (0x10000, 0x2FA20))
        chosen = [blocks[k] for k in random.integers(len(blocks), size=random.integers(1, 30))]
        return "a" + "".join(chr(random.integers(*block)) for block in chosen)

    makers = (caption, spoilt, anything, lambda: " ".join(caption() for _ in range(random.integers(2, 12))))
    return [makers[k % 4]() for k in range(count)]


def write_vectors(out: Path, portable: Path, count: int = 200) -> Path:
    """Write all files below ``out``, made with the portable files below ``portable``; gives ``vectors.json``.

    Raises:
        InvalidInputError: the portable files of :data:`MODELS` are not there.
    """
    needed = [portable / f"{name}.portable.onnx" for name in MODELS]
    if missing := [str(path) for path in needed if not path.is_file()]:
        raise InvalidInputError(
            f"{', '.join(missing)} missing; first: python -m motionrt_export portable -o {portable}"
        )
    out.mkdir(parents=True, exist_ok=True)
    sessions = FloatSessions(portable)
    said = texts(count)
    tokenizer = load_tokenizer(sessions)
    np.save(out / "embeddings.npy", TextMotionModel(sessions, text_tower="full").embed_text(said[:EMBEDDED]))
    _walk(out, sessions)
    found = {
        "version": 1,
        "models": {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in needed},
        "texts": [{"text": text, "ids": tokenizer.encode(text).ids} for text in said],
        "walk": {"speed": SPEED, "goals": [{"from": first, "goal": goal} for first, goal in GOALS]},
        "motions": _motions(out, sessions),
    }
    path = out / "vectors.json"
    path.write_text(json.dumps(found, indent=1) + "\n", encoding="ascii")
    return path


def _walk(out: Path, sessions: Sessions) -> None:
    history = history_of(stride())[None].astype(np.float64).round(6)
    crowd = Crowd(WalkModel(sessions), history)
    goals = [next(goal for first, goal in reversed(GOALS) if first <= frame) for frame in range(FRAMES)]
    frames = np.stack([crowd.step(np.array([goal]), SPEED)[0] for goal in goals])
    np.save(out / "walk_history.npy", history[0].astype(np.float32))
    np.save(out / "walk_frames.npy", frames.astype(np.float32))


def _motions(out: Path, sessions: Sessions) -> list[dict[str, Any]]:
    generator, encoder, found = MotionGenerator(sessions), SentenceEncoder(sessions), []
    for number, (text, seconds, seed) in enumerate(MOTIONS):
        sampling = Sampling(seconds=seconds, seed=seed)
        wanted = Wanted((Line(text, 0.0, seconds),))
        frames = wanted.canvas(generator.words).frames
        np.save(out / f"motion_{number}_features.npy", encoder.encode(text).token_features[0])
        np.save(out / f"motion_{number}_noise.npy", sampling.noise(0, frames * ego77.WIDTH).reshape(frames, -1))
        np.save(out / f"motion_{number}_rows.npy", motion_rows(generator.generate(wanted, sampling)[0]))
        found.append(
            {"text": text, "seconds": seconds, "seed": seed, "steps": sampling.calls, "guidance": sampling.weight}
        )
    return found
