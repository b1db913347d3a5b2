"""A benchmark as a table, as Markdown, as a picture and as a command, on tiny models. No test looks at a time."""

from __future__ import annotations

import importlib.util
import json
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from tiny_models import TINY, TINY_GENERATORS, copy_tiny

from motionrt.bench import footprint, markdown, plot, tables, worker
from motionrt.bench.cases import BENCHMARKS
from motionrt.bench.graphs import called_with, graph_feeds
from motionrt.bench.locomotion import walk_case
from motionrt.bench.search import TEXT, answer_case, motion_case, search_case
from motionrt.bench.timing import Turns
from motionrt.cli import main
from motionrt.errors import InvalidInputError, MissingDependencyError
from motionrt.models import find_manifest, load_manifest

WITHOUT_MODELS = {"walk", "transition", "pose", "perform"}  # of which there are no tiny ones
SCRIPTS = Path(__file__).parents[2] / "benchmarks"


def case(name: str, p50: float, **against: float) -> dict[str, Any]:
    """A case of which nothing but the medians matters."""
    others = {
        rival: {"p50_ms": other, "p95_ms": 2 * other, "runs": 4, "ratio": other / p50}
        for rival, other in against.items()
    }
    return {"case": name, "units": 1, "p50_ms": p50, "p95_ms": 2 * p50, "runs": 4, "against": others}


COLD = {
    "seconds": 0.25,
    "runs": 2,
    "import_s": 0.1,
    "python_s": 0.02,
    "retrieve_s": None,
    "peak_mb": 140.4,
    "against": {"torch": {"seconds": 2.5, "ratio": 10.0, "peak_mb": 481.0}},
}
FOUND: dict[str, Any] = {
    "machine": {"system": "Linux", "processor": "A processor", "cores": 2},
    "versions": {"python": "3.11.7", "motionrt": "0.1.0"},
    "settings": {"rounds": 1, "against": ["torch", "transformers"]},
    "install_mb": {"scipy": 143.0, "numpy": 71.4, "click": 1.0, "idna": 0.6},
    "runs": [
        {
            "threads": 1,
            "cases": [
                case(TEXT, 2.0, torch=10.0, transformers=11.0),
                *(case(walk_case(n), 1.6 / n, torch=8.0 / n) for n in (1, 8, 64)),
                *(case(motion_case(n), 3.4, torch=11.0) for n in (1, 8, 64)),
                *(case(search_case(n), n / 1e5, torch=n / 5e4) for n in (1_000, 10_000, 100_000)),
                *(case(answer_case(n), 2 + n / 1e5, torch=24.0, transformers=25.0) for n in (1_000, 10_000)),
            ],
            "left_out": {"perform": "no model walknet"},
            "called": {},
            "cold_start": COLD,
            "peak_mb": {"text": 142.0},
            "perform_times_real_time": 44.4,
        }
    ],
    "installed": {
        "motionrt": {"megabytes": 378.2, "largest": {"scipy": 83.2}, "first_s": 0.8, "seconds": 0.7, "retrieve_s": 0.6},
        "torch + transformers": {"megabytes": 991.0, "largest": {}, "first_s": 8.6, "seconds": 8.1, "retrieve_s": None},
    },
    "models": {"walknet": {"p50_ms": 1.0, "p95_ms": 2.0, "threads": 1, "call": "batch 1"}},
}


def test_rows_have_two_columns_for_every_rival() -> None:
    run = {**FOUND["runs"][0], "cases": FOUND["runs"][0]["cases"][:1]}
    found = tables.rows(run, ["torch", "transformers"])
    assert {len(row) for row in found} == {len(tables.header(1, ["torch", "transformers"]))} == {8}
    assert found[0] == [TEXT, "2.00 ms", "4.00 ms", "500/s", "10.0 ms", "5.0 x", "11.0 ms", "5.5 x"]
    assert ["cold start to first text", "250 ms", "", "", "2,500 ms", "10.0 x", "", ""] in found
    assert ["peak memory, first text", "140 MB", "", "", "481 MB", "", "", ""] in found
    assert ["perform, times real time", "44.4 x", "", "", "", "", "", ""] in found
    assert not any(row[0] == "motionrt retrieve" for row in found)


def test_strict_figures_have_rows_of_their_own() -> None:
    run = {"cases": [{**case(TEXT, 2.0, torch=4.0), "strict": case(TEXT, 3.0, torch=9.0)}]}
    assert tables.strict_rows(run, ["torch"]) == [
        [f"{TEXT}, call by call", "3.00 ms", "6.00 ms", "", "9.00 ms", "3.0 x"]
    ]


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0314, "0.03 ms"), (9.996, "10.00 ms"), (12.34, "12.3 ms"), (2500, "2,500 ms"), (15600, "15.6 s")],
)
def test_milliseconds_have_about_three_figures(value: float, text: str) -> None:
    assert tables.ms(value) == text


def test_small_packages_are_added_up() -> None:
    assert tables.install_rows(FOUND["install_mb"]) == [
        ["scipy", "143 MB"],
        ["numpy", "71 MB"],
        ["2 others", "2 MB"],
        ["base install", "216 MB"],
    ]


def test_the_readme_table_has_the_chosen_rows() -> None:
    found = markdown.readme_table(FOUND).splitlines()
    assert found[0] == "A processor, 2 cores, one thread, medians:"
    assert found[2:4] == ["|  | motionrt | torch |  | torch + transformers |  |", "|---|---:|---:|---:|---:|---:|"]
    assert "| embed a text | 2.00 ms | 10.0 ms | 5.0 x | 11.0 ms | 5.5 x |" in found
    assert "| perform a script, against real time | 44 x |  |  |  |  |" in found
    assert "| fresh installation, on the disk | 378 MB |  |  | 991 MB | 2.6 x |" in found
    assert {line.count("|") for line in found[2:]} == {7}


def test_all_tables_have_cells_under_every_title() -> None:
    limit = {"case": TEXT, "macs_int8_m": 234.2, "macs_fp32_m": 1.9, "weights_mb": 16.8, "sums_ms": 1.17}
    limit |= {"reads_ms": 0.26, "p50_ms": 2.0, "times_limit": 1.7}
    run = {**FOUND["runs"][0], "limits": {"peaks": {"read_gbs": {"cache": 60.0}}, "benchmarks": [limit]}}
    found = markdown.performance_tables({**FOUND, "runs": [run]})
    for table in (part.splitlines() for part in found.split("\n\n") if part.startswith("|")):
        assert {line.count("|") for line in table} == {table[0].count("|")}
    assert "| `motionrt retrieve`, whole command | 0.60 s |  |" in found
    assert "Left out: perform (no model walknet)." in found
    assert "| text encoding | 234.2 | 1.9 | 16.8 | 1.17 ms | 0.26 ms | 2.00 ms | 1.7 x |" in found


def test_tables_go_between_markers_and_nothing_else_changes() -> None:
    text = "before\n<!-- bench -->\nold\n<!-- /bench -->\nafter\n"
    assert markdown.between(text, "bench", "new \\1") == "before\n<!-- bench -->\nnew \\1\n<!-- /bench -->\nafter\n"


@pytest.mark.parametrize("text", ["nothing", "<!-- bench -->", "<!-- bench --><!-- /bench -->" * 2])
def test_a_document_without_one_pair_of_markers_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="one pair of lines <!-- bench -->"):
        markdown.between(text, "bench", "new")


def test_a_picture_shows_every_contender_once_for_each_kind_of_work(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    path = plot.save_plot(FOUND, tmp_path / "bench.png")
    assert path.read_bytes().startswith(b"\x89PNG")


def test_a_picture_of_nothing_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    with pytest.raises(InvalidInputError, match="nothing to plot"):
        plot.save_plot({**FOUND, "runs": [{**FOUND["runs"][0], "cases": []}]}, tmp_path / "bench.png")


def test_a_picture_without_matplotlib_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(MissingDependencyError, match=r'pip install "motionrt\[plot\]"'):
        plot.save_plot(FOUND, tmp_path / "bench.png")


def test_the_base_install_is_motionrt_and_what_it_requires_without_extras() -> None:
    found = footprint.install_sizes()
    assert {"motionrt", "numpy", "onnxruntime", "tokenizers", "scipy", "pyyaml"} <= set(found)
    assert not {"pytest", "ruff", "torch"} & set(found)
    assert list(found.values()) == sorted(found.values(), reverse=True)
    assert found["numpy"] > 10


def test_inputs_of_a_model_have_the_shapes_that_the_manifest_names() -> None:
    manifest = load_manifest(TINY / "models_manifest.yaml")
    model = manifest.models["tmr_motion"]
    feeds = graph_feeds(model)
    assert called_with(model) == "batch 1, frames 200"
    assert feeds["motion"].shape == (1, 200, 263)
    assert feeds["mask"].dtype == bool
    assert feeds["mask"].all()


def test_a_transition_is_asked_for_the_gap_that_it_can_fill() -> None:
    hidden = graph_feeds(load_manifest(find_manifest()).models["transnet"])["hidden"]
    assert hidden.shape == (1, 120)
    assert np.flatnonzero(hidden).tolist() == list(range(60, 119))


@pytest.fixture(scope="module")
def tiny(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All tiny models under one manifest."""
    folder = copy_tiny(tmp_path_factory.mktemp("bench"))
    shutil.copytree(TINY_GENERATORS / "models", folder / "models", dirs_exist_ok=True)
    manifest = folder / "models_manifest.yaml"
    contents = [yaml.safe_load((each / manifest.name).read_text(encoding="utf-8")) for each in (TINY_GENERATORS, TINY)]
    contents[1]["models"] = {**contents[0]["models"], **contents[1]["models"]}
    # a file of both folders is the second one's: so its models go first
    shutil.copytree(TINY / "models", folder / "models", dirs_exist_ok=True)
    manifest.write_text(yaml.safe_dump(contents[1], sort_keys=False), encoding="utf-8")
    return manifest


def test_every_benchmark_with_models_runs(tiny: Path) -> None:
    found = worker.measure(str(tiny), 2, turns=Turns(1, 1, 0), sizes=(1_000, 2_000))
    assert set(found["left_out"]) == WITHOUT_MODELS
    assert set(found["models"]) == set(load_manifest(tiny).models)
    assert len(found["cases"]) > len(BENCHMARKS) - len(WITHOUT_MODELS)
    assert all(row["p50_ms"] > 0 and row["p95_ms"] > 0 for row in found["cases"])


def test_the_command_measures_prints_and_draws(tiny: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = [] if importlib.util.find_spec("matplotlib") is None else ["--plot", str(tmp_path / "bench.png")]
    asked = ["--quick", "--threads", "1", "--models", str(tiny), "--sizes", "1000", "--only", "text,search,cold,models"]
    assert main(["bench", "--json", "--limits", "--strict", *asked, *picture]) == 0
    found = json.loads(capsys.readouterr().out)
    assert list(found) == ["machine", "versions", "settings", "install_mb", "runs", "models"]
    run = found["runs"][0]
    assert {"threads", "cases", "left_out", "cold_start", "peak_mb", "limits"} <= set(run)
    assert run["cold_start"]["seconds"] > run["cold_start"]["import_s"] > 0
    assert set(run["peak_mb"]) == {"import", "text"}
    assert {row["benchmark"] for row in run["limits"]["benchmarks"]} == {"text", "search"}
    assert set(found["models"]["tmr_text"]) == {"p50_ms", "p95_ms", "threads", "call"}
    assert not picture or (tmp_path / "bench.png").stat().st_size > 10_000
    assert "| embed a text |" in markdown.readme_table(found)
    assert "times the limit" in markdown.performance_tables(found)


def test_the_command_prints_a_table_or_markdown(tiny: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["bench", "--quick", "--threads", "1", "--models", str(tiny), "--only", "parts"]
    assert main([*asked, "--markdown"]) == 0
    assert "| body parts of a text |" in capsys.readouterr().out
    assert main(asked) == 0
    assert "threads: 1" in capsys.readouterr().out


def test_the_command_profiles_a_benchmark(tiny: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--profile", "text", "--threads", "1", "--models", str(tiny)]) == 0
    found = capsys.readouterr().out
    assert "tmr_student" in found
    assert "outside of models" in found
    assert main(["bench", "--profile", "walk", "--threads", "1", "--models", str(tiny)]) == 1
    assert "needs models that are not there: walknet" in capsys.readouterr().err


def test_a_release_is_published_from_its_figures(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    monkeypatch.syspath_prepend(str(SCRIPTS))
    monkeypatch.delitem(sys.modules, "install", raising=False)
    everything = importlib.import_module("all")
    figures, readme, document = (tmp_path / name for name in ("bench.json", "README.md", "performance.md"))
    figures.write_text(json.dumps(FOUND), encoding="utf-8")
    for each in (readme, document):
        each.write_text("# Title\n<!-- bench -->\n<!-- /bench -->\n", encoding="utf-8")
    asked = ["--out", str(tmp_path / "out"), "--figures", str(figures), "--documents", str(readme), str(document)]
    assert everything.main(asked) == 0
    assert json.loads((tmp_path / "out" / "bench.json").read_text(encoding="utf-8")) == FOUND
    assert (tmp_path / "out" / "bench.png").is_file()
    assert "| embed a text |" in readme.read_text(encoding="utf-8")
    assert "text encoding" in document.read_text(encoding="utf-8")
    document.write_text("no markers", encoding="utf-8")
    assert everything.main(asked) == 1
