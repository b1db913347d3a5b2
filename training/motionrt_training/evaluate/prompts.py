"""Do generated motions show what was asked for? The retrieval encoders, which never saw one, are the judge.

Every motion has to find its own prompt among 32, the other 31 drawn at random, again and again. Beside the generator
stand chance, the recorded motion whose caption is nearest to the prompt (what mere lookup gives, among motions that the
judge was trained on and among others), and recorded motions of the test split among their own captions (what the judge
is capable of).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np

from motionrt import metrics
from motionrt.errors import FormatError, InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.feet.lock import lock_feet
from motionrt.motion.skeleton import FloatArray
from motionrt_training.corpora.actions import ActionClip
from motionrt_training.evaluate.simultaneous import clip_motion
from motionrt_training.evaluate.tables import markdown

PROMPTS = Path(__file__).with_name("prompts.txt")
REPEATS = 200  # batches of 32 that every motion is ranked in


class Maker(Protocol):
    """What is asked of ``motionrt.Runtime``."""

    def generate(
        self, text: str, *, seconds: float, seed: int, n: int, sampler: str, foot_lock: bool
    ) -> Sequence[Motion]:
        """Motions of texts; see :meth:`motionrt.Runtime.generate`."""

    def embed_text(self, text: Sequence[str]) -> FloatArray:
        """Unit embeddings of texts."""

    def embed_motion(self, motion: Sequence[Motion]) -> FloatArray:
        """Unit embeddings of motions."""


@dataclass(frozen=True)
class Prompt:
    """What to generate, and for how long."""

    seconds: float
    text: str


@dataclass(frozen=True)
class PromptRow:
    """How motions rank and move; ``None`` where there is nothing to measure.

    Attributes:
        motions: how many.
        recall_1, recall_3: percent of batches of 32 in which the own text ranks so high.
        median_rank: MedR.
        skate_cm: foot skate, cm per frame at 30 fps.
        jerk: m/s^3.
        energy: mean speed of joints seen from the pelvis, m/s.
        contact_speed, contact_share: of feet at contact, m/s, and how often they are, 0 to 1.
        diversity, multimodality: distances of unit embeddings.
        fid: Frechet distance from recordings, of unit embeddings.
        by_text: percent of rank 1 for every text.
    """

    motions: int
    recall_1: float
    recall_3: float
    median_rank: float
    skate_cm: float | None = None
    jerk: float | None = None
    energy: float | None = None
    contact_speed: float | None = None
    contact_share: float | None = None
    diversity: float | None = None
    multimodality: float | None = None
    fid: float | None = None
    by_text: tuple[float, ...] = ()


def read_prompts(path: str | Path = PROMPTS) -> list[Prompt]:
    """Lines of ``seconds | prompt``; empty ones and those that begin with # are skipped.

    Raises:
        FormatError: another line, with its number.
        InvalidInputError: no prompt at all.
    """
    source, found = Path(path), []
    for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        seconds, separator, text = line.partition("|")
        try:
            found.append(Prompt(float(seconds), text.strip()))
        except ValueError:
            separator = ""
        if not separator or not text.strip():
            raise FormatError(source, "expected 'seconds | prompt'", number)
    if not found:
        raise InvalidInputError(f"{source} holds no prompt")
    return found


def generated(
    maker: Maker, prompts: Sequence[Prompt], samples: int, sampler: str, *, foot_lock: bool
) -> list[list[Motion]]:
    """``samples`` motions of every prompt; with and without foot lock they are the same motions."""
    return [
        list(maker.generate(p.text, seconds=p.seconds, seed=seed, n=samples, sampler=sampler, foot_lock=foot_lock))
        for seed, p in enumerate(prompts)
    ]


def looked_up(
    prompts: Sequence[Prompt], clips: Sequence[ActionClip], sentences: Callable[[list[str]], FloatArray]
) -> list[list[Motion]]:
    """For every prompt the clip with the nearest caption by the sentence embedding ``(N, d)``, unit vectors."""
    owners = [clip for clip in clips for _ in clip.captions]
    captions = sentences([caption for clip in clips for caption in clip.captions])
    nearest = (sentences([prompt.text for prompt in prompts]) @ captions.T).argmax(axis=1)
    return [[clip_motion(owners[int(index)])] for index in nearest]


def judged(
    maker: Maker,
    texts: Sequence[str],
    motions: Sequence[Sequence[Motion]],
    repeats: int = REPEATS,
    recordings: FloatArray | None = None,
) -> PromptRow:
    """Rank and measure motions ``motions[i]`` of text ``i``, as many for every text.

    `recordings` are embeddings ``(N, d)`` of recorded motions, which the Frechet distance is taken from.
    """
    groups = np.stack([maker.embed_motion(list(group)) for group in motions])  # (texts, motions of each, d)
    flat = groups.reshape(-1, groups.shape[-1])
    right = np.repeat(np.arange(len(texts)), groups.shape[1])
    ranks = metrics.matching_ranks(flat @ maker.embed_text(list(texts)).T, right, repeats=repeats)
    found = metrics.scores(ranks.ravel())
    first = (ranks == 1).reshape(len(texts), -1).mean(axis=1)
    return PromptRow(
        len(flat),
        found.recall[1],
        found.recall[3],
        found.median_rank,
        **moved([motion for group in motions for motion in group]),
        diversity=metrics.diversity(flat) if len(flat) > 1 else None,
        multimodality=metrics.multimodality(groups) if groups.shape[1] > 1 else None,
        fid=metrics.frechet_distance(flat, recordings)
        if recordings is not None and min(len(flat), len(recordings)) > 1
        else None,
        by_text=tuple(float(100 * share) for share in first),
    )


def by_chance() -> PromptRow:
    """What ranking at random gives."""
    found = metrics.chance()
    return PromptRow(0, found.recall[1], found.recall[3], found.median_rank)


def frozen(motions: Sequence[Sequence[Motion]]) -> list[list[Motion]]:
    """The first pose of every motion, held."""
    return [[held(motion) for motion in group] for group in motions]


def held(motion: Motion) -> Motion:
    """The first frame, as often as there are frames."""
    first = np.zeros(motion.frames, int)
    return replace(motion, rotations=motion.rotations[first], root=motion.root[first])


def recorded(
    maker: Maker,
    clips: Sequence[ActionClip],
    style: int = 1,
    *,
    locked: bool = False,
    recordings: FloatArray | None = None,
) -> PromptRow:
    """Clips among one caption of each."""
    motions = [clip_motion(clip).grounded() for clip in clips]
    texts = [clip.captions[style % len(clip.captions)] for clip in clips]
    shown = [[lock_feet(motion) if locked else motion] for motion in motions]
    return judged(maker, texts, shown, recordings=recordings)


def moved(motions: Sequence[Motion]) -> dict[str, float]:
    """Means over motions at 30 fps, each stood on its floor: foot skate, jerk, energy, speed and share of contacts."""
    rows = []
    for motion in motions:
        joints = motion.grounded().positions()
        feet = metrics.footing(joints, motion.fps)
        rows.append(
            {
                "skate_cm": feet.skate_cm,
                "jerk": metrics.jerk(joints, motion.fps),
                "energy": metrics.motion_energy(joints, motion.fps),
                "contact_speed": feet.contact_speed,
                "contact_share": feet.contact_share,
            }
        )
    return {name: float(np.mean([row[name] for row in rows])) for name in rows[0]}


def prompt_page(rows: Mapping[str, PromptRow], prompts: Sequence[Prompt], samples: int) -> str:
    """The table in Markdown, with what it shows."""
    head = ["", "motions", "R@1", "R@3", "MedR", *(name for name, _, _ in _MOVEMENT)]
    body = [
        [
            name,
            row.motions or "",
            f"{row.recall_1:.1f}",
            f"{row.recall_3:.1f}",
            f"{row.median_rank:.1f}",
            *(_cell(getattr(row, field), digits) for _, field, digits in _MOVEMENT),
        ]
        for name, row in rows.items()
    ]
    return _INTRODUCTION.format(prompts=len(prompts), samples=samples) + "\n\n" + markdown(head, body) + "\n"


def as_json(rows: Mapping[str, PromptRow], prompts: Sequence[Prompt]) -> dict[str, object]:
    """Everything in plain values."""
    return {"rows": {name: asdict(row) for name, row in rows.items()}, "prompts": [asdict(p) for p in prompts]}


def _cell(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"


_MOVEMENT = (
    ("foot skate", "skate_cm", 2),
    ("at contact", "contact_speed", 2),
    ("contacts", "contact_share", 2),
    ("jerk", "jerk", 1),
    ("energy", "energy", 2),
    ("diversity", "diversity", 2),
    ("multimodality", "multimodality", 2),
    ("FID", "fid", 2),
)
_INTRODUCTION = """{prompts} prompts, {samples} motions of each. Every motion ranks its own text among 32, the others
drawn at random; recalls in percent. Foot skate in cm per frame at 30 fps, speed of feet at contact in m/s and how often
they are, jerk in m/s^3, energy: mean speed of joints seen from the pelvis, m/s. Diversity, multimodality and FID (from
the recorded training clips): of the unit embeddings of the retrieval model, which also does the ranking and was never
trained on generated motion."""
