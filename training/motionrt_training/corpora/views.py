"""Views for the generator, drawn once: stretches of recordings as ``ego77``, what was measured there and what is said.

A view is a stretch of 0.5 to 10 s. It may hold a captioned span and what lies about it, two spans one after the other
("A, then B"), a part of one, or frames that no caption speaks of; some are bent along a curve, play at another speed or
have the arms of another recording. What recordings seldom show is drawn oftener than it is recorded.
Slots and numbers are measured on the very frames that the network sees.

    python -m motionrt_training.corpora.views runs/positions.npz -o runs/views.npz --count 40000
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt.motion.attributes import Attributes, measure
from motionrt.motion.features import ego77
from motionrt.text import attribute_targets, parse_query, slots_of_motion
from motionrt_training.corpora.composed import acting_arms, with_arms
from motionrt_training.corpora.positions import CaptionedSpan, PackedRecording, unpack_positions
from motionrt_training.data_record import data_of
from motionrt_training.wording.measured import say_measured
from motionrt_training.wording.pairs import sentence
from motionrt_training.wording.saying import THEN

LEAST, MOST = 10, 200  # frames of a view at 20 fps
LENGTHS = ((0.5, 64, 100), (0.25, 16, 72), (0.25, 100, MOST))  # part of the views, frames from, to
ALONE = 0.5  # part of the spans shorter than the view that stay without what lies about them
UNTOLD = 0.1  # part of the views that no caption speaks of
SPEED, SPED = 0.15, 0.4  # largest change of speed, and part of the views that have one
BENT, MOST_BEND = 0.25, np.radians(90)  # part of the travelling views that are bent, and by how much at most
MOST_BEND_RATE = np.radians(25) / ego77.FPS
OF_LEGS = {"walk", "turn", "run", "jog", "sidestep", "stand", "march", "sit", "squat", "stairs", "kneel", "sneak"}
COMPOSED = 0.25  # part of the views of these actions that have the arms of another recording
DONOR_LEAN = 25  # degrees that whoever lends arms may lean
SHORT = 9  # words of a caption that stands beside another one
BALANCE = (0.5, 5.0)  # least and most often that an action is drawn beside its share of the time
DONATED = 40  # least frames of a span whose arms are lent
SPOKEN = 2  # sentences made from what was measured

Row = tuple[NDArray[np.float16], dict[str, Any]]


@dataclass(frozen=True)
class Views:
    """The pack: `features` of all views one after the other, and one row of each per view."""

    features: NDArray[np.float16]  # (frames, 77)
    start: NDArray[np.int64]
    length: NDArray[np.int64]
    slots: NDArray[np.int64]  # (N, S)
    targets: NDArray[np.float32]  # (N, A)
    known: NDArray[np.bool_]  # (N, A)
    captions: list[list[str]]
    spoken: list[list[str]]  # sentences made from what was measured
    sources: list[str]

    def __len__(self) -> int:
        return len(self.start)

    def motion(self, index: int) -> NDArray[np.float16]:
        """(F, 77) of one view."""
        return self.features[self.start[index] : self.start[index] + self.length[index]]


def load_views(path: str | Path) -> Views:
    """What `main` wrote."""
    with np.load(path) as pack:
        arrays = {name: pack[name] for name in ("features", "start", "length", "slots", "targets", "known")}
        words = json.loads(str(pack["words"]))
    return Views(**arrays, captions=words["captions"], spoken=words["spoken"], sources=words["sources"])


def draw_views(recordings: Sequence[PackedRecording], count: int, seed: int) -> Iterator[Row]:
    """`count` views, spans and untold stretches in proportion to their time."""
    rng = np.random.default_rng(seed)
    spans = [(recording, span) for recording in recordings for span in recording.spans]
    actions = [_action(span) for _, span in spans]
    weight = np.array([min(max(span.count, 40), 240) for _, span in spans], float) * _balance(spans, actions)
    seconds = np.array([len(recording.joints) for recording in recordings], float)
    donors = [(span, *found) for recording, span in spans if (found := _donor(recording, span))]
    for _ in range(count):
        if rng.random() < UNTOLD:
            recording = recordings[int(rng.choice(len(recordings), p=seconds / seconds.sum()))]
            action, (first, frames) = None, _untold(recording, rng)
        else:
            number = int(rng.choice(len(spans), p=weight / weight.sum()))
            recording, span = spans[number]
            action, (first, frames) = actions[number], _about(recording, span, rng)
        if frames < LEAST:
            continue
        joints = recording.joints[first : first + frames].astype(np.float64)
        captions = _said(recording.spans, first, frames, rng)
        if donors and captions and action in OF_LEGS and rng.random() < COMPOSED:
            joints, captions = _composed(joints, captions, donors[int(rng.integers(len(donors)))], rng)
        yield _row(joints, captions, recording.source, rng)


def _balance(
    spans: Sequence[tuple[PackedRecording, CaptionedSpan]], actions: Sequence[str | None]
) -> NDArray[np.float64]:
    """How often each span is drawn beside its length: the less there is of its action, the oftener."""
    total: Counter[str | None] = Counter()
    for action, (_, span) in zip(actions, spans, strict=True):
        total[action] += span.count
    mean = float(np.mean(list(total.values())))
    return np.array([np.clip(np.sqrt(mean / total[action]), *BALANCE) for action in actions])


def _action(span: CaptionedSpan) -> str | None:
    """The action that most of a span's captions name."""
    named = Counter(action for text in span.captions if (action := parse_query(text).action))
    return named.most_common(1)[0][0] if named else None


def _donor(recording: PackedRecording, span: CaptionedSpan) -> tuple[NDArray[np.float32], tuple[str, ...]] | None:
    """Joints of a span that arms alone do, and these arms."""
    joints = recording.joints[span.first : span.first + span.count]
    if span.count < DONATED or not span.captions:
        return None
    found = measure(joints, ego77.FPS)
    if found.pelvis_lowest < 0.8 or found.lean_max > DONOR_LEAN:
        return None
    arms = acting_arms(joints)
    return (joints, arms) if arms else None


def _composed(
    joints: NDArray[np.float64],
    captions: list[str],
    donor: tuple[CaptionedSpan, NDArray[np.float32], tuple[str, ...]],
    rng: np.random.Generator,
) -> tuple[NDArray[np.float64], list[str]]:
    """A view with the arms of another one, and what is said of both."""
    span, arms_of, arms = donor
    frames = min(len(joints), len(arms_of))
    first = int(rng.integers(0, len(arms_of) - frames + 1))
    said = [sentence(caption, str(rng.choice(_short(span.captions))), rng) for caption in _short(captions)[:3]]
    return with_arms(joints[:frames], arms_of[first : first + frames], arms), said


def _length(rng: np.random.Generator) -> int:
    part, low, high = zip(*LENGTHS, strict=True)
    k = int(rng.choice(len(part), p=part))
    return int(rng.integers(low[k], high[k] + 1))


def _untold(recording: PackedRecording, rng: np.random.Generator) -> tuple[int, int]:
    frames = min(_length(rng), len(recording.joints))
    return int(rng.integers(0, len(recording.joints) - frames + 1)), frames


def _about(recording: PackedRecording, span: CaptionedSpan, rng: np.random.Generator) -> tuple[int, int]:
    """First frame and frames of a view in a span, or about it."""
    wanted, total = _length(rng), len(recording.joints)
    if span.count >= wanted:
        return span.first + int(rng.integers(0, span.count - wanted + 1)), wanted
    if rng.random() < ALONE:
        return span.first, span.count
    low, high = max(0, span.first + span.count - wanted), min(span.first, max(0, total - wanted))
    first = int(rng.integers(min(low, high), max(low, high) + 1))
    return first, min(wanted, total - first)


def _short(captions: Sequence[str]) -> list[str]:
    """Captions that can stand beside another one in a sentence."""
    short = [caption for caption in captions if len(caption.split()) <= SHORT] or captions[:1]
    return [caption.rstrip(".") for caption in short]


def _row(joints: NDArray[np.float64], captions: list[str], source: str, rng: np.random.Generator) -> Row:
    if rng.random() < SPED:
        joints = _at_speed(joints, float(np.exp(rng.uniform(-SPEED, SPEED))))
    joints = joints[:MOST]
    features, found = ego77.encode(joints), measure(joints, ego77.FPS)
    if found.path_length > 1.0 and found.upside_down_share == 0 and rng.random() < BENT:
        features = _bent(features, rng)
        joints = ego77.decode(features)
        found = measure(joints, ego77.FPS)
        captions = captions if abs(found.path_bend) < 40 else []
    return features.astype(np.float16), _meta(source, found, captions, rng)


def _meta(source: str, found: Attributes, captions: list[str], rng: np.random.Generator) -> dict[str, Any]:
    targets, known = attribute_targets(found)
    return {
        "slots": slots_of_motion(found), "targets": targets, "known": known, "captions": captions,
        "spoken": say_measured(found, rng, SPOKEN), "source": source,
    }  # fmt: skip


def _said(spans: Sequence[CaptionedSpan], first: int, frames: int, rng: np.random.Generator) -> list[str]:
    """Captions of the spans that a view shows, in order of time where there are several."""
    shown = [span for span in spans if _share(span, first, frames) > 0]
    told = [span for span in shown if _share(span, first, frames) > 0.65] or shown
    best = [span for span in told if _overlap(span, first, frames) > 0.6 * frames]
    if best or len(told) == 1:
        return _texts((best or told)[0])
    if len(told) != 2:
        return []
    return [
        f"{a.rstrip('.')}{rng.choice(THEN)}{b[:1].lower()}{b[1:]}" for a, b in zip(*map(_texts, told), strict=False)
    ]


def _texts(span: CaptionedSpan) -> list[str]:
    joined = " and ".join(span.labels)
    return [*span.captions, *([joined] if joined else [])]


def _overlap(span: CaptionedSpan, first: int, frames: int) -> int:
    return max(0, min(span.first + span.count, first + frames) - max(span.first, first))


def _share(span: CaptionedSpan, first: int, frames: int) -> float:
    """Part of the span, or of the view where that is shorter, that both have in common."""
    return _overlap(span, first, frames) / min(span.count, frames)


def _at_speed(joints: NDArray[np.float64], speed: float) -> NDArray[np.float64]:
    times = np.arange(0, len(joints) - 1, speed)
    before = times.astype(int)
    part = (times - before)[:, None, None]
    return np.asarray(joints[before] * (1 - part) + joints[np.minimum(before + 1, len(joints) - 1)] * part)


def _bent(features: NDArray[np.float32], rng: np.random.Generator) -> NDArray[np.float32]:
    """The same walk along a curve: some turn more at every frame, which carries the joints along."""
    most = min(MOST_BEND / len(features), MOST_BEND_RATE)
    bent = features.copy()
    bent[:, 0] += rng.uniform(-most, most)
    return bent


def _many(task: tuple[str, int, int]) -> list[Row]:
    path, count, seed = task
    recordings = [one for one in unpack_positions(path) if one.split == "train"]
    return list(draw_views(recordings, count, seed))


def pack_views(positions: str | Path, count: int, seed: int, path: str | Path, processes: int = 2) -> Path:
    """Draw `count` views of the training recordings and write them to ``path``; returns it."""
    chunk = 1000
    tasks = [(str(positions), min(chunk, count - first), seed + first) for first in range(0, count, chunk)]
    with ProcessPoolExecutor(processes) as pool:
        rows = [row for some in tqdm(pool.map(_many, tasks), total=len(tasks)) for row in some]
    lengths = np.array([len(features) for features, _ in rows])
    metas = [meta for _, meta in rows]
    words = {"captions": [m["captions"] for m in metas], "spoken": [m["spoken"] for m in metas]}
    words["sources"] = [m["source"] for m in metas]
    np.savez(
        path,
        features=np.concatenate([features for features, _ in rows]),
        start=np.cumsum(lengths) - lengths,
        length=lengths,
        **{name: np.stack([m[name] for m in metas]) for name in ("slots", "targets", "known")},
        words=json.dumps(words, ensure_ascii=False),
        provenance=json.dumps(data_of(positions)),
    )
    return Path(path)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Draw the views that the generator is trained on.")
    parser.add_argument("positions", help="the packed positions")
    parser.add_argument("-o", "--output", required=True, help="the pack of views (.npz)")
    parser.add_argument("--count", type=int, default=40000)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    print(pack_views(args.positions, args.count, args.seed, args.output))


if __name__ == "__main__":
    main()
