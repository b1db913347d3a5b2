"""A made-up BABEL over a made-up AMASS, small enough to train every network on it for four steps."""

from __future__ import annotations

from pathlib import Path

from corpus_trees import amass_tree, babel_entry, babel_label, write_json

TRAIN, VAL = 6, 3  # sequences


def own_data(folder: Path) -> tuple[Path, Path]:
    """BABEL and AMASS below ``folder``: walks of 8 s with a wave in their middle."""
    names = [f"KIT/{number}/walk_poses" for number in range(TRAIN)] + [f"HDM05/{n}/walk_stageii" for n in range(VAL)]
    amass = amass_tree(folder / "amass", names, seconds=8.0)
    babel = folder / "babel"
    write_json(babel / "train.json", {str(number): _entry(name, number) for number, name in enumerate(names[:TRAIN])})
    rest = enumerate(names[TRAIN:], start=TRAIN)
    write_json(
        babel / "val.json", {str(number): _entry(name.replace("HDM05", "MPI_HDM05"), number) for number, name in rest}
    )
    return babel, amass


def _entry(name: str, number: int) -> dict[str, object]:
    other = "wave the right hand" if number < TRAIN else "raise the left arm"
    labels = babel_label("walk forward", 0, 8), babel_label(other, 3, 6.5), babel_label("nod", 0.5, 1.5)
    return babel_entry(name.replace("_stageii", "_poses"), *labels, seconds=8.0)
