"""The zip of the add-on: what is in it, and that the wheel that it carries is what is installed."""

from __future__ import annotations

import importlib.util
import sys
import types
import zipfile
from pathlib import Path

import pytest

BLENDER = Path(__file__).parents[2] / "integrations" / "blender"


def loaded(name: str, file: Path) -> types.ModuleType:
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def wheel(tmp_path: Path) -> Path:
    file = tmp_path / "motionrt-0.1.0-py3-none-any.whl"
    file.write_bytes(b"a wheel")
    return file


def test_the_zip_holds_one_folder_with_the_manifest_and_the_wheel(tmp_path: Path, wheel: Path) -> None:
    make = loaded("make_extension", BLENDER / "make_extension.py")
    out = tmp_path / "addon.zip"
    assert make.main(["-o", str(out), "--wheel", str(wheel)]) == 0
    names = zipfile.ZipFile(out).namelist()
    assert {name.split("/")[0] for name in names} == {"motionrt_blender"}
    assert "motionrt_blender/blender_manifest.toml" in names
    assert f"motionrt_blender/wheel/{wheel.name}" in names
    sources = {file.name for file in (BLENDER / "motionrt_blender").glob("*.py")}
    assert sources <= {Path(name).name for name in names}
    assert make.main(["-o", str(out), "--wheel", str(tmp_path / "other.whl")]) == 1


def test_the_wheel_that_the_zip_carries_is_installed_unless_another_source_is_chosen(
    tmp_path: Path, wheel: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bpy = types.ModuleType("bpy")
    bpy.utils = types.SimpleNamespace(user_resource=lambda _, path: str(tmp_path / path))  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    installing = loaded("installing", BLENDER / "motionrt_blender" / "installing.py")
    asked: list[str] = []
    monkeypatch.setattr(installing, "_pip", lambda *arguments: asked.append(arguments[-1]))
    monkeypatch.setattr(installing, "_older_numpy", lambda: None)
    monkeypatch.setattr(installing, "CARRIED", tmp_path / "none")
    installing.install()
    monkeypatch.setattr(installing, "CARRIED", tmp_path)
    installing.install()
    installing.install("motionrt==0.1")
    assert asked == ["motionrt", str(wheel), "motionrt==0.1"]
