"""Tables of ablations: every row is a command that its recipe understands, and finished rows are not trained again."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

from motionrt_training.checkpoint import save_atomically
from motionrt_training.evaluate.ablations import (
    TABLES,
    checkpoint_page,
    command_of,
    folder_of,
    main,
    train_rows,
    trained,
)
from motionrt_training.recipes import temos, tmr, transnet

RECIPES = {"tmr": tmr, "temos": temos, "transnet": transnet}


def options(folder: Path, also: str = "--layers 3") -> argparse.Namespace:
    return argparse.Namespace(corpus=folder / "a.npz", captions=folder / "c.jsonl", out=folder, minutes=2.0, also=also)


@pytest.mark.parametrize("name", sorted(TABLES))
def test_every_row_is_understood_by_its_recipe_and_has_the_same_budget(name: str, tmp_path: Path) -> None:
    table = TABLES[name]
    for row in table.rows:
        _, module, recipe, *words = command_of(table, row, options(tmp_path))
        assert (module, recipe) == ("-m", f"motionrt_training.recipes.{table.recipe}")
        parsed = RECIPES[table.recipe].parser().parse_args(words)
        assert (parsed.minutes, parsed.layers) == (2.0, 3)
    assert len({row.name for row in table.rows}) == len(table.rows)


def test_the_published_rows_are_there() -> None:
    assert [row.name for row in TABLES["filtering"].rows if "paper" in row.name] == ["0.8 (the paper's)"]
    rows = [row for row in TABLES["synthetic"].rows if row.name.startswith("real pairs") and "random" not in row.name]
    assert [row.options.rpartition(" ")[2] for row in rows] == ["0", "0.25", "0.5", "1"]


def test_rows_are_trained_once_and_their_own_measures_make_the_page(tmp_path: Path) -> None:
    table, asked = TABLES["losses"], []

    def train(words: list[str]) -> None:
        asked.append(words)
        folder = Path(words[words.index("--out") + 1])
        state = {"measures": {"test_t2m_R1": 10.0 + len(asked)}, "step": 7, "elapsed": 120.0}
        save_atomically(state, folder / "best.pt")

    train_rows(table, options(tmp_path), train)
    train_rows(table, options(tmp_path), train)
    assert len(asked) == len(table.rows)
    page = checkpoint_page(table, trained(table, options(tmp_path)), tmp_path)
    assert "| margin loss | 7 | 2.0 | 13.0 | nan |" in page


def test_tables_share_what_is_trained_alike() -> None:
    inputs, synthetic = TABLES["inputs"], TABLES["synthetic"]
    alone = TABLES["synthetic"].rows[4]
    assert alone.name == "no real pairs, 0 % synthetic"
    singles = [folder_of(Path("x"), inputs, row) for row in inputs.rows[:2]]
    assert singles[0] == singles[1] == folder_of(Path("x"), synthetic, alone)
    sinc = folder_of(Path("x"), inputs, inputs.rows[3])
    assert sinc in [folder_of(Path("x"), synthetic, row) for row in synthetic.rows]


def test_the_list_is_printed_and_missing_captions_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["losses", "--corpus", "a.npz", "--out", str(tmp_path), "--list"])
    assert len(capsys.readouterr().out.splitlines()) == len(TABLES["losses"].rows)
    with pytest.raises(SystemExit, match="error: SINC, Table 3 needs --captions"):
        main(["synthetic", "--corpus", "a.npz", "--out", str(tmp_path)])


def test_only_the_rows_that_are_there_are_measured_when_nothing_is_to_be_trained(tmp_path: Path) -> None:
    table = TABLES["rivals"]
    asked = ["rivals", "--corpus", "a.npz", "--out", str(tmp_path), "--minutes", "6", "--trained"]
    with pytest.raises(SystemExit, match="error: no row of the table is trained in"):
        main(asked)
    state = {"measures": {"test_t2m_R1": 12.5}, "step": 9, "elapsed": 360.0}
    save_atomically(state, folder_of(tmp_path, table, table.rows[0]) / "best.pt")
    main(asked)
    lines = (tmp_path / "rivals.md").read_text(encoding="utf-8").splitlines()
    assert lines[-1].startswith("| Guo-style: GRUs, margin loss | 9 | 6.0 | 12.5 |")
    assert len([line for line in lines if line.startswith("|")]) == 3


def test_transitions_are_told_in_centimetres_and_skate(tmp_path: Path) -> None:
    table = TABLES["window"]
    state = {"measures": {"joint_cm": 12.34, "pose_cm": 5.0, "skate": 1.234}, "step": 9, "elapsed": 360.0}
    save_atomically(state, folder_of(tmp_path, table, table.rows[1]) / "best.pt")
    page = checkpoint_page(table, trained(table, options(tmp_path)), tmp_path)
    assert page.splitlines()[-1] == "| M = 120 (the paper's) | 9 | 6.0 | 12.3 | 5.0 | 1.23 |"
