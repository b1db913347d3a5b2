"""The roads through motionrt that are measured, the models that each needs, and what is called."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import cycle

from motionrt.bench.makes import BODY_PARTS, COMPOSE, compose_call, generate_calls, parts_call
from motionrt.bench.moves import CROWDS, PERFORM, POSE, TRANSITION, pose_call, transition_call, walk_call, walk_case
from motionrt.bench.timing import Case
from motionrt.bench.workload import ANSWER, MOTION, SEARCH_SIZES, TEXT, TOP, Workload, search_call, search_case
from motionrt.errors import InvalidInputError
from motionrt.locomotion.actions import Act, WalkTo
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.performing import Performer
from motionrt.locomotion.players import ModelPlayers
from motionrt.locomotion.spreading import Spread
from motionrt.models import Sessions
from motionrt.models.latent_denoiser import DENOISER
from motionrt.models.pose_prior import MODEL as POSE_PRIOR
from motionrt.models.temos import DECODER
from motionrt.models.temos import TEXT as TEMOS_TEXT
from motionrt.models.text import MODEL as SENTENCES
from motionrt.models.tmr import MOTION as TMR_MOTION
from motionrt.models.tmr import TEXT as TMR_TEXT
from motionrt.models.transnet import TRANSNET
from motionrt.models.walknet import WALKNET, WalkModel
from motionrt.runtime import Runtime

COLD = "cold"  # measured outside of the process that measures the others
SCRIPT = (
    WalkTo(0.0, 4.0),
    Act({"right_hand": (-0.2, 1.2, 5.2), "left_foot": (0.12, 0.0, 4.8), "right_foot": (-0.12, 0.0, 4.8)}, hold_s=1.0),
    WalkTo(3.0, 2.0),
)


class Setting:
    """Models and inputs that the roads share; each opens when a road needs it."""

    def __init__(self, models: str | None, threads: int, work: Workload) -> None:
        self.models, self.threads, self.work = models, threads, work
        self.runtime = Runtime(models, threads=threads)

    @cached_property
    def players(self) -> ModelPlayers:
        """The models of walking and acting."""
        return ModelPlayers(Sessions(self.models, threads=self.threads))

    def missing(self, needed: Sequence[str]) -> list[str]:
        """Those of the models that the manifest does not hold."""
        return [name for name in needed if name not in self.players.sessions.manifest.models]


@dataclass(frozen=True)
class Road:
    """A road: the models that it needs, and its cases by name."""

    models: tuple[str, ...]
    cases: Callable[[Setting], Mapping[str, Case]]


def _text(setting: Setting) -> Mapping[str, Case]:
    texts, model = cycle(setting.work.texts), setting.runtime.model
    return {TEXT: Case(lambda: model.embed_text([next(texts)]))}


def _motion(setting: Setting) -> Mapping[str, Case]:
    model, work = setting.runtime.model, setting.work
    return {MOTION: Case(lambda: model.embed_motion([work.features]))}


def _search(setting: Setting) -> Mapping[str, Case]:
    vectors = setting.work.vectors
    return {search_case(size): Case(search_call(vectors[:size], vectors[-1])) for size in SEARCH_SIZES}


def _retrieve(setting: Setting) -> Mapping[str, Case]:
    texts, runtime = cycle(setting.work.texts), setting.runtime
    gallery = setting.work.gallery(runtime.model.name, runtime.model.fingerprint)
    return {ANSWER: Case(lambda: runtime.retrieve(next(texts), TOP, gallery))}


def _walk(setting: Setting) -> Mapping[str, Case]:
    moves, model = setting.work.moves, setting.players.walk
    cases = {walk_case(count): Case(walk_call(model, moves, count), count) for count in CROWDS}
    if setting.threads > 1:
        spread = Spread(WalkModel(Sessions(setting.models, threads=1)), setting.threads)
        more = {walk_case(n, spread=True): Case(walk_call(spread, moves, n), n) for n in CROWDS if n > 1}
        cases |= more
    return cases


def _transition(setting: Setting) -> Mapping[str, Case]:
    return {TRANSITION: Case(transition_call(setting.players.infill, setting.work.moves))}


def _pose(setting: Setting) -> Mapping[str, Case]:
    return {POSE: Case(pose_call(setting.players.prior, setting.work.moves))}


def _perform(setting: Setting) -> Mapping[str, Case]:
    """A walk, a grab and a walk; a first run tells how many frames that takes."""

    def perform() -> int:
        return Performer(setting.players, Goal(0.0, 0.0)).perform(SCRIPT).motion.frames

    return {PERFORM: Case(perform, perform(), slow=True)}


def _generate(setting: Setting) -> Mapping[str, Case]:
    return {name: Case(call) for name, call in generate_calls(setting.runtime.generator).items()}


def _compose(setting: Setting) -> Mapping[str, Case]:
    return {COMPOSE: Case(compose_call(setting.runtime))}


def _parts(setting: Setting) -> Mapping[str, Case]:
    return {BODY_PARTS: Case(parts_call(setting.runtime))}


ROADS: Mapping[str, Road] = {
    "text": Road((SENTENCES, TMR_TEXT), _text),
    "motion": Road((TMR_MOTION,), _motion),
    "search": Road((), _search),
    "retrieve": Road((SENTENCES, TMR_TEXT, TMR_MOTION), _retrieve),
    "walk": Road((WALKNET,), _walk),
    "transition": Road((TRANSNET,), _transition),
    "pose": Road((POSE_PRIOR,), _pose),
    "perform": Road((WALKNET, TRANSNET, POSE_PRIOR), _perform),
    "generate": Road((SENTENCES, TEMOS_TEXT, DECODER, DENOISER), _generate),
    "compose": Road((), _compose),
    "parts": Road((), _parts),
    COLD: Road((SENTENCES, TMR_TEXT, TMR_MOTION), lambda _: {}),
}
"""All roads, in the order in which they are measured and shown."""


def chosen(only: Sequence[str] | None) -> dict[str, Road]:
    """The roads of these names, or all.

    Raises:
        InvalidInputError: a name that is none.
    """
    if unknown := [name for name in only or () if name not in ROADS]:
        raise InvalidInputError(f"no road is called {', '.join(unknown)}; choose from: {', '.join(ROADS)}")
    return {name: road for name, road in ROADS.items() if only is None or name in only}
