"""The inference engine is the caller's choice: any package that has ``onnxruntime``, any of its providers."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from fake_embedder import FakeEmbedder
from motions import walking
from tiny_models import TINY

from motionrt import Runtime
from motionrt.errors import InvalidInputError, MissingDependencyError
from motionrt.models import Sessions
from motionrt.models.engine import CPU, checked_providers, open_session
from motionrt.retrieval import Gallery, coded_scan
from motionrt.retrieval.search import CODED_FROM, ExactIndex

GPU = ["StandInExecutionProvider", ("CPUExecutionProvider", {"arena_extend_strategy": "kSameAsRequested"})]


class StandInOptions:
    def add_session_config_entry(self, _: str, __: str) -> None: ...


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """A package with the module ``onnxruntime`` and a provider that this machine lacks; lists what was opened."""
    opened: list[Any] = []

    class Session:
        def __init__(self, model: object, options: object, providers: object) -> None:
            opened.append(providers)

    module = ModuleType("onnxruntime")
    module.__version__ = "99.0"  # type: ignore[attr-defined]
    module.SessionOptions = StandInOptions  # type: ignore[attr-defined]
    module.InferenceSession = Session  # type: ignore[attr-defined]
    module.get_available_providers = lambda: ["StandInExecutionProvider", *CPU]  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "onnxruntime", module)
    return opened


def test_providers_reach_the_session_in_their_order_and_with_their_options(stand_in: list[Any]) -> None:
    Sessions(TINY, providers=GPU).session("tmr_text")
    assert stand_in == [GPU]


def test_the_runtime_hands_its_providers_to_all_models(stand_in: list[Any]) -> None:
    runtime = Runtime(TINY, providers=GPU)
    runtime.sessions.session("tmr_text")
    runtime.model.sessions.session("tmr_motion")
    assert stand_in == [GPU, GPU]


def test_the_scan_of_a_large_gallery_runs_on_the_same_providers(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def noted(model: object, options: object, providers: Any) -> Any:
        asked.append(providers)
        return open_session(model, options, CPU)  # type: ignore[arg-type]

    monkeypatch.setattr(coded_scan, "open_session", noted)
    vectors = np.random.default_rng(0).normal(size=(CODED_FROM, 32)).astype(np.float32)
    ExactIndex(vectors, providers=GPU).prepare()
    assert asked == [tuple(GPU)] * 2  # the check that its products are exact, and the scan


def test_a_gallery_hands_its_providers_to_the_scan(tmp_path: Path) -> None:
    embedder = FakeEmbedder()
    Gallery.from_motions([walking(30)], ["walk"], embedder).save(tmp_path)
    assert Gallery.open(tmp_path, providers=GPU).providers == GPU


def test_the_cpu_is_the_default(stand_in: list[Any]) -> None:
    Sessions(TINY).session("tmr_text")
    assert stand_in == [["CPUExecutionProvider"]]


def test_a_provider_that_is_not_there_is_named_with_those_that_are(stand_in: list[Any]) -> None:
    with pytest.raises(InvalidInputError, match=r"99\.0 has no provider CUDA.*; it has: StandIn.*, CPU"):
        Sessions(TINY, providers=["CUDAExecutionProvider"]).session("tmr_text")
    assert stand_in == []


def test_without_any_onnxruntime_the_message_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "onnxruntime", None)  # as if no package had it
    with pytest.raises(MissingDependencyError, match="pip install onnxruntime, or onnxruntime-gpu"):
        Runtime(TINY).embed_text("walk")


@pytest.mark.parametrize("wrong", ["CPUExecutionProvider", [], [7], [("CPUExecutionProvider",)], {"a": 1}])
def test_what_is_no_list_of_providers_is_refused_at_once(wrong: Any) -> None:
    with pytest.raises(InvalidInputError, match="provider"):
        Runtime(TINY, providers=wrong)


def test_providers_are_kept_as_they_were_given() -> None:
    assert checked_providers(GPU) == tuple(GPU)
