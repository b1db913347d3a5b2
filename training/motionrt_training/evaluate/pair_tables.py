"""TEMOS score, APE and AVE of two actions at once, in the form of SINC's tables 2 and 3."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields

import numpy as np

from motionrt import metrics
from motionrt.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt_training.evaluate.simultaneous import ActionPair
from motionrt_training.evaluate.tables import markdown
from motionrt_training.evaluate.ways import Way

MotionEncoder = Callable[[Motion], FloatArray]  # motion at 30 fps -> (d,)
Scores = dict[str, float]


@dataclass(frozen=True)
class Measures:
    """Means over pairs.

    Attributes:
        scores: TEMOS score by each motion encoder.
        each: the same of every pair, so that rows can be compared pair by pair.
        ape: metres.
        ave: square metres.
    """

    scores: Scores
    ape: metrics.PositionErrors
    ave: metrics.PositionErrors
    each: Mapping[str, list[float]] = field(default_factory=dict)


@dataclass(frozen=True)
class PairRow:
    """One way to make two actions, measured.

    Attributes:
        pairs: how many.
        mean: the motion of the mean latent.
        average: mean over the samples; None without samples.
        best: of every pair the sample that is nearest to the truth by mean global APE.
    """

    pairs: int
    mean: Measures
    average: Measures | None = None
    best: Measures | None = None


class Ruler:
    """Measures any way against the same truths, which are encoded once."""

    def __init__(self, pairs: Sequence[ActionPair], encoders: Mapping[str, MotionEncoder], samples: int = 0) -> None:
        self._pairs, self._encoders, self._samples = pairs, encoders, samples
        self._bodies = [metrics.Body.of(pair.truth) for pair in pairs]
        self._truth = {name: _encoded(encode, [pair.truth for pair in pairs]) for name, encode in encoders.items()}

    def row(self, way: Way) -> PairRow:
        """Make every pair in one way and measure it."""
        made = [[motion.canonical() for motion in way(pair, self._samples)] for pair in self._pairs]
        mean = self._measured([motions[0] for motions in made])
        if not self._samples:
            return PairRow(len(made), mean)
        draws = [self._measured([motions[n] for motions in made]) for n in range(1, self._samples + 1)]
        best = self._measured([_nearest(motions[1:], body) for motions, body in zip(made, self._bodies, strict=True)])
        return PairRow(len(made), mean, _average(draws), best)

    def _measured(self, motions: Sequence[Motion]) -> Measures:
        bodies = [metrics.Body.of(motion) for motion in motions]
        each = {
            name: [float(s) for s in metrics.temos_scores(_encoded(encode, motions), self._truth[name])]
            for name, encode in self._encoders.items()
        }
        means = {name: float(np.mean(scores)) for name, scores in each.items()}
        return Measures(means, metrics.ape(bodies, self._bodies), metrics.ave(bodies, self._bodies), each)


def pair_table(rows: Mapping[str, PairRow], which: str = "mean") -> str:
    """Rows in Markdown; ``which`` of mean, average and best."""
    measured = {name: getattr(row, which) for name, row in rows.items()}
    columns = [field.name.replace("_", " ") for field in fields(metrics.PositionErrors)]
    encoders = list(next(iter(measured.values())).scores)
    head = ["", *(f"score ({name})" for name in encoders), *(f"{kind} {c}" for kind in ("APE", "AVE") for c in columns)]
    body = [
        [
            name,
            *(f"{row.scores[encoder]:.3f}" for encoder in encoders),
            *(f"{value:.3f}" for value in row.ape.as_dict().values()),
            *(f"{value:.4f}" for value in row.ave.as_dict().values()),
        ]
        for name, row in measured.items()
    ]
    return markdown(head, body)


def difference(scores: Sequence[float], others: Sequence[float]) -> str:
    """How far scores are above those of another row for the same pairs: mean and its standard error."""
    apart = np.subtract(scores, others)
    return f"{apart.mean():+.3f} ± {apart.std(ddof=1) / len(apart) ** 0.5:.3f}" if len(apart) > 1 else ""


def difference_table(rows: Mapping[str, PairRow]) -> str:
    """Each row's scores less those of the first, pair by pair, of the mean latents."""
    measured = {name: row.mean for name, row in rows.items()}
    first, *others = measured
    encoders = list(measured[first].each)
    body = [[name, *(difference(measured[name].each[e], measured[first].each[e]) for e in encoders)] for name in others]
    return markdown([f"less '{first}'", *(f"score ({name})" for name in encoders)], body)


def pair_page(rows: Mapping[str, PairRow], pairs: Sequence[ActionPair], samples: int) -> str:
    """All tables, and on how many pairs."""
    fitting = sum(pair.fits for pair in pairs)
    parts = [_INTRODUCTION.format(pairs=len(pairs), fitting=fitting), "**Mean latent**", pair_table(rows)]
    parts += ["**Mean latent, pair by pair**", difference_table(rows)]
    if samples:
        parts += [f"**Mean over {samples} samples**", pair_table(rows, "average")]
        parts += [f"**Best of {samples} samples by mean global APE**", pair_table(rows, "best")]
    return "\n\n".join(parts) + "\n"


def as_json(rows: Mapping[str, PairRow], pairs: Sequence[ActionPair]) -> dict[str, object]:
    """Everything in plain values."""
    named = [{"id": pair.id, "text": pair.sentence, "compatible": pair.fits} for pair in pairs]
    return {"rows": {name: asdict(row) for name, row in rows.items()}, "pairs": named}


def _nearest(motions: Sequence[Motion], truth: metrics.Body) -> Motion:
    errors = [metrics.ape([metrics.Body.of(motion)], [truth]).mean_global for motion in motions]
    return motions[int(np.argmin(errors))]


def _average(draws: Sequence[Measures]) -> Measures:
    scores = {name: float(np.mean([draw.scores[name] for draw in draws])) for name in draws[0].scores}
    ape, ave = (_mean_errors([getattr(draw, name) for draw in draws]) for name in ("ape", "ave"))
    return Measures(scores, ape, ave)


def _mean_errors(errors: Sequence[metrics.PositionErrors]) -> metrics.PositionErrors:
    rows = [list(error.as_dict().values()) for error in errors]
    return metrics.PositionErrors(*(float(value) for value in np.mean(rows, axis=0)))


def _encoded(encode: MotionEncoder, motions: Sequence[Motion]) -> FloatArray:
    return np.stack([encode(motion) for motion in motions])


_INTRODUCTION = """{pairs} test clips with two simultaneous labels; in {fitting} of them the two need different parts of
the body. All motions are as long as the recording, 30 fps, from the origin, facing +Z. Score: (1 + cosine) / 2 of a
motion encoder's means, one encoder for all rows. APE in metres, AVE in square metres."""
