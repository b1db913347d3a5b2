"""Checkpoints of every network: released from a trainer's file, read back, and refused where they do not fit."""

from __future__ import annotations

from pathlib import Path

import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the training extra brings it")
pytest.importorskip("safetensors", reason="safetensors is not installed; the training extra brings it")

from motionrt_training.checkpoint import NETWORKS, load_any, load_release, main, trained_model  # noqa: E402
from motionrt_training.networks.pose_prior import PosePrior  # noqa: E402
from motionrt_training.networks.walknet import WalkNet  # noqa: E402

TINY = {
    "tmr": {"d": 32, "layers": 1, "heads": 2, "ff": 32},
    "text_student": {"vocabulary": 50, "words": 16, "d": 32, "layers": 1, "heads": 2, "ff": 32, "out": 32},
    "walknet": {"d": 32, "layers": 1, "heads": 2, "ff": 32},
    "transnet": {"d": 32, "layers": 1, "heads": 2, "ff": 32},
    "pose_prior": {"latent": 4, "width": 16},
    "temos": {"d": 32, "layers": 1, "heads": 2, "ff": 32},
    "latent_denoiser": {"latent": 8, "d": 32, "layers": 3, "heads": 2, "ff": 32},
    "motion_denoiser": {"d": 32, "layers": 1, "heads": 2, "ff": 32, "slots": [3, 2], "owners": [0] * 77},
}


def trained(name: str, path: Path, **more: object) -> torch.nn.Module:
    torch.manual_seed(0)
    model = NETWORKS[name](**TINY[name])
    state = {"model": model.state_dict(), "step": 7, "elapsed": 90.0, "seed": 3, "notes": {"network": model.config}}
    torch.save({**state, **more}, path)
    return model


@pytest.mark.parametrize("name", list(NETWORKS))
def test_every_network_is_released_and_read_back(tmp_path: Path, name: str) -> None:
    model = trained(name, tmp_path / "best.pt", measures={"score": 1.5})
    out = tmp_path / "released" / f"{name}.safetensors"
    main([str(tmp_path / "best.pt"), "--network", name, "-o", str(out), "--command", "train it"])
    found, notes = load_release(out, type(model))
    assert not found.training
    assert {key: notes[key] for key in ("network", "seed", "steps", "minutes", "command")} == {
        "network": name,
        "seed": "3",
        "steps": "7",
        "minutes": "1.5",
        "command": "train it",
    }
    for key, value in found.named_parameters():
        assert torch.equal(value, model.state_dict()[key].half().float())


def test_statistics_are_kept_in_full(tmp_path: Path) -> None:
    model = WalkNet(**TINY["walknet"])
    model.pose_mean.fill_(1 / 3)
    torch.save(
        {"model": model.state_dict(), "step": 1, "elapsed": 0.0, "notes": {"network": model.config}}, tmp_path / "x.pt"
    )
    main([str(tmp_path / "x.pt"), "--network", "walknet", "-o", str(tmp_path / "x.safetensors")])
    assert torch.equal(load_any(tmp_path / "x.safetensors", WalkNet).pose_mean, model.pose_mean)


def test_of_a_checkpoint_to_go_on_from_the_average_is_taken(tmp_path: Path) -> None:
    model = NETWORKS["pose_prior"](**TINY["pose_prior"])
    average = [parameter.detach() + 1 for parameter in model.parameters()]
    state = {"model": model.state_dict(), "average": average, "notes": {"network": model.config}}
    for found, value in zip(trained_model(state, PosePrior).parameters(), average, strict=True):
        assert torch.equal(found, value)


def test_another_network_is_refused_by_name(tmp_path: Path) -> None:
    trained("pose_prior", tmp_path / "best.pt")
    main([str(tmp_path / "best.pt"), "--network", "pose_prior", "-o", str(tmp_path / "p.safetensors")])
    with pytest.raises(ValueError, match="holds the network 'pose_prior', not 'walknet'"):
        load_release(tmp_path / "p.safetensors", WalkNet)


def test_the_first_releases_which_name_no_network_are_of_tmr(tmp_path: Path) -> None:
    from safetensors.torch import save_file

    save_file({"x": torch.zeros(1)}, tmp_path / "old.safetensors", {"config": "{}"})
    with pytest.raises(ValueError, match="holds the network 'tmr', not 'pose_prior'"):
        load_release(tmp_path / "old.safetensors", PosePrior)
