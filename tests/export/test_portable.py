"""Files for engines: standard operators alone, equal to torch, refused where an engine's list does not have them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

import onnx
from onnx import TensorProto, helper

from motionrt.errors import InvalidInputError
from motionrt_export import portable
from motionrt_export.sources import Sources
from motionrt_export.targets import targets

MODELS = Path(__file__).parents[2] / "models"


@pytest.fixture(scope="module")
def index(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("portable")
    return portable.build(Sources(MODELS), out, lambda _: None, ["walknet", "pose_prior", "temos_text"])


def test_a_file_holds_standard_operators_of_opset_15_and_no_branch(index: Path) -> None:
    for entry in json.loads(index.read_text())["models"].values():
        model = onnx.load(index.parent / entry["file"])
        assert [(one.domain, one.version) for one in model.opset_import] == [("", 15)]
        assert not {"If", "Loop", "Scan"} & {node.op_type for node in model.graph.node}
        assert entry["elsewhere"]["unity"] == []


def test_the_index_says_what_a_file_takes_and_how_far_it_is_from_torch(index: Path) -> None:
    entry = json.loads(index.read_text())["models"]["walknet"]
    model = onnx.load(index.parent / entry["file"])
    assert [value.name for value in model.graph.input] == [one["name"] for one in entry["inputs"]]
    assert entry["parity"]["next"]["max_abs_error"] < 1e-3
    assert "| `walknet` | " in portable.table(index)


@pytest.mark.parametrize("name", ["tmr_text", "tmr_student", "motion_denoiser", "transnet"])
def test_every_engine_opens_the_other_models(name: str) -> None:
    portable.engines(portable.portable(Sources(MODELS).source(name)), name)


def test_an_engine_refuses_operators_of_others_and_newer_ones() -> None:
    unity = targets()["unity"]
    assert unity.refuses(_model("Gelu", "com.microsoft", 15)) == ["operators of com.microsoft"]
    assert unity.refuses(_model("If", "", 15)) == ["If"]
    assert unity.refuses(_model("Abs", "", 18)) == ["opset 18, newer than 15"]
    assert unity.refuses(_model("Abs", "", 15)) == []
    assert targets()["webgpu"].refuses(_model("ConvInteger", "", 15)) == []
    assert targets()["webgpu"].outside(_model("ConvInteger", "", 15)) == ["ConvInteger"]


def test_an_unknown_model_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"no model walk; choose from: .*walknet"):
        portable.build(Sources(MODELS), tmp_path / "out", print, ["walk"])
    assert not (tmp_path / "out").exists()


def _model(operator: str, domain: str, opset: int) -> onnx.ModelProto:
    value = helper.make_tensor_value_info("x", TensorProto.FLOAT, [1])
    result = helper.make_tensor_value_info("y", TensorProto.FLOAT, [1])
    graph = helper.make_graph([helper.make_node(operator, ["x"], ["y"], domain=domain)], "g", [value], [result])
    imports = [helper.make_opsetid(domain, 1)] if domain else []
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", opset), *imports])
