"""All benchmarks: the models that each needs, its cases, and what is called for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from motionrt.bench import generation, locomotion, search
from motionrt.bench.files import CLIPS, GALLERY, file_calls, gallery_call
from motionrt.bench.graphs import graph_call, graph_case
from motionrt.bench.setting import TEXT_TOWER, Setting
from motionrt.bench.timing import Case
from motionrt.errors import InvalidInputError
from motionrt.locomotion.actions import Act, WalkTo
from motionrt.locomotion.spreading import Spread
from motionrt.models import Sessions
from motionrt.models.latent_denoiser import DENOISER
from motionrt.models.motion_denoiser import MODEL as MOTION_DENOISER
from motionrt.models.pose_prior import MODEL as POSE_PRIOR
from motionrt.models.temos import DECODER
from motionrt.models.temos import TEXT as TEMOS_TEXT
from motionrt.models.tmr import MOTION as TMR_MOTION
from motionrt.models.tmr import STUDENT as TMR_STUDENT
from motionrt.models.tmr import TEXT as TMR_TEXT
from motionrt.models.transnet import TRANSNET
from motionrt.models.walknet import WALKNET, WalkModel

COLD = "cold"  # measured outside of the process that measures the others
SPREAD = (8, 64)  # characters that are spread over threads, too
SCRIPT = (
    WalkTo(0.0, 4.0),
    Act({"right_hand": (-0.2, 1.2, 5.2), "left_foot": (0.12, 0.0, 4.8), "right_foot": (-0.12, 0.0, 4.8)}, hold_s=1.0),
    WalkTo(3.0, 2.0),
)


@dataclass(frozen=True)
class Benchmark:
    """The models that a benchmark needs, its cases by name, and whether it runs only when it is asked for."""

    models: tuple[str, ...]
    cases: Callable[[Setting], Mapping[str, Case]]
    on_request: bool = False


def _text(setting: Setting) -> Mapping[str, Case]:
    return {search.TEXT: Case(search.text_call(setting.runtime.model, setting.work))}


def _full_text(setting: Setting) -> Mapping[str, Case]:
    return {search.FULL_TEXT: Case(search.text_call(setting.full_text, setting.work))}


def _motion(setting: Setting) -> Mapping[str, Case]:
    runtime, work = setting.runtime, setting.work
    return {search.motion_case(n): Case(search.motion_call(runtime, work, n), n, slow=n > 8) for n in search.CLIPS}


def _search(setting: Setting) -> Mapping[str, Case]:
    work = setting.work
    return {search.search_case(n): Case(search.search_call(work.vectors[:n], work.vectors[-1])) for n in work.sizes}


def _approximate(setting: Setting) -> Mapping[str, Case]:
    work = setting.work
    return {
        search.approximate_case(n): Case(search.approximate_call(work.vectors[:n], work.vectors[-1]))
        for n in work.sizes
    }


def _retrieve(setting: Setting) -> Mapping[str, Case]:
    runtime, work = setting.runtime, setting.work
    return {search.answer_case(n): Case(search.answer_call(runtime, work, n)) for n in work.sizes}


def _generate(setting: Setting) -> Mapping[str, Case]:
    return {name: Case(call) for name, call in generation.generate_calls(setting.runtime.generator).items()}


def _decode(setting: Setting) -> Mapping[str, Case]:
    return {generation.DECODE: Case(generation.decode_call(setting.runtime.generator))}


def _compose(setting: Setting) -> Mapping[str, Case]:
    return {generation.COMPOSE: Case(generation.compose_call(setting.runtime))}


def _parts(setting: Setting) -> Mapping[str, Case]:
    return {generation.BODY_PARTS: Case(generation.parts_call(setting.runtime))}


def _walk(setting: Setting) -> Mapping[str, Case]:
    inputs, model = setting.work.moves, setting.character_models.walk
    cases = {locomotion.walk_case(n): Case(locomotion.walk_call(model, inputs, n), n) for n in locomotion.CROWDS}
    if setting.threads > 1:
        each = WalkModel(Sessions(setting.models, threads=1), setting.variant)
        spread = Spread(each, setting.threads)
        cases |= {
            locomotion.walk_case(n, spread=True): Case(locomotion.walk_call(spread, inputs, n), n) for n in SPREAD
        }
    return cases


def _transition(setting: Setting) -> Mapping[str, Case]:
    return {
        locomotion.TRANSITION: Case(locomotion.transition_call(setting.character_models.infill, setting.work.moves))
    }


def _pose(setting: Setting) -> Mapping[str, Case]:
    return {locomotion.POSE: Case(locomotion.pose_call(setting.character_models.prior, setting.work.moves))}


def _perform(setting: Setting) -> Mapping[str, Case]:
    """A walk, a grab and a walk; a first run tells how many frames that takes."""

    def perform() -> int:
        return setting.runtime.perform(None, SCRIPT, start=(0.0, 0.0)).motion.frames

    return {locomotion.PERFORM: Case(perform, perform(), slow=True)}


def _files(setting: Setting) -> Mapping[str, Case]:
    return {name: Case(call) for name, call in file_calls(setting.folder).items()}


def _gallery(setting: Setting) -> Mapping[str, Case]:
    return {GALLERY: Case(gallery_call(setting.runtime, setting.folder), CLIPS, slow=True)}


def _models(setting: Setting) -> Mapping[str, Case]:
    """One call of every model that can be opened in the wanted variant."""
    found = {}
    for name in setting.manifest.models:
        if setting.manifest.locate(setting.manifest.variant(name, setting.variant).file).is_file():
            found[graph_case(name)] = Case(graph_call(setting.sessions(name), name, setting.variant))
    return found


BENCHMARKS: Mapping[str, Benchmark] = {
    "text": Benchmark((TEXT_TOWER,), _text),
    "full-text": Benchmark((TMR_STUDENT, TMR_TEXT), _full_text),  # the same as text where there is no other tower
    "motion": Benchmark((TMR_MOTION,), _motion),
    "search": Benchmark((), _search),
    "retrieve": Benchmark((TEXT_TOWER, TMR_MOTION), _retrieve),
    "approximate": Benchmark((), _approximate, on_request=True),
    "gallery": Benchmark((TMR_MOTION,), _gallery),
    "generate": Benchmark((TMR_TEXT, TEMOS_TEXT, DECODER, DENOISER, MOTION_DENOISER), _generate),
    "decode": Benchmark((DECODER,), _decode),
    "compose": Benchmark((), _compose),
    "parts": Benchmark((), _parts),
    "walk": Benchmark((WALKNET,), _walk),
    "transition": Benchmark((TRANSNET,), _transition),
    "pose": Benchmark((POSE_PRIOR,), _pose),
    "perform": Benchmark((WALKNET, TRANSNET, POSE_PRIOR), _perform),
    "files": Benchmark((), _files),
    "models": Benchmark((), _models),
    COLD: Benchmark((TEXT_TOWER, TMR_MOTION), lambda _: {}),
}
"""All benchmarks, in the order in which they are shown."""


def chosen(only: Sequence[str] | None) -> dict[str, Benchmark]:
    """The benchmarks of these names, or all that need not be asked for.

    Raises:
        InvalidInputError: a name that is none.
    """
    if unknown := [name for name in only or () if name not in BENCHMARKS]:
        raise InvalidInputError(f"no benchmark is called {', '.join(unknown)}; choose from: {', '.join(BENCHMARKS)}")
    return {
        name: benchmark
        for name, benchmark in BENCHMARKS.items()
        if (not benchmark.on_request if only is None else name in only)
    }
