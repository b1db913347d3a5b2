"""What is measured of retrieval: texts and motions embedded, vectors searched, and a text's answer as a whole."""

from __future__ import annotations

from itertools import cycle

from motionrt.bench.timing import Call
from motionrt.bench.workload import TOP, Workload
from motionrt.models import TextMotionModel
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import ExactIndex
from motionrt.retrieval.approximate import ApproximateIndex
from motionrt.runtime import Runtime

TEXT = "text encoding"
FULL_TEXT = "text encoding, full tower"
CLIPS = (1, 8, 64)  # that are embedded together


def motion_case(clips: int) -> str:
    """Name of embedding so many clips of 10 s; the time is that of one clip."""
    return f"motion encoding, {clips} clip{'s' if clips > 1 else ''} of 10 s"


def search_case(size: int) -> str:
    """Name of the search over ``size`` vectors."""
    return f"search {size:,}"


def approximate_case(size: int) -> str:
    """Name of the approximate search over ``size`` vectors."""
    return f"approximate search {size:,}"


def answer_case(size: int) -> str:
    """Name of a text query over ``size`` clips."""
    return f"text to top {TOP} of {size:,}"


def text_call(model: TextMotionModel, work: Workload) -> Call:
    """One text embedded."""
    texts = cycle(work.texts)
    return lambda: model.embed_text([next(texts)])


def motion_call(runtime: Runtime, work: Workload, clips: int) -> Call:
    """So many clips embedded, given in one call."""
    features, model = [work.features] * clips, runtime.model
    return lambda: model.embed_motion(features)


def search_call(vectors: FloatArray, query: FloatArray) -> Call:
    """One exact search, as it is after many: the index has made its copy."""
    index = ExactIndex(vectors)
    index.prepare()
    return lambda: index.nearest(query, TOP)


def approximate_call(vectors: FloatArray, query: FloatArray) -> Call:
    """One approximate search; MissingDependencyError where its package is missing."""
    index = ApproximateIndex(vectors, ExactIndex(vectors))
    index.prepare()
    return lambda: index.nearest(query, TOP)


def answer_call(runtime: Runtime, work: Workload, size: int) -> Call:
    """A text, and the best of so many clips, as it is after many."""
    texts = cycle(work.texts)
    gallery = work.gallery(size, runtime.model.name, runtime.model.fingerprint).prepare()
    return lambda: runtime.retrieve(next(texts), TOP, gallery)
