"""The motionrt package in a folder of the user's, for Blender's own Python; no administrator rights are needed."""

from __future__ import annotations

import importlib
import importlib.util
import subprocess
import sys
from pathlib import Path

import bpy

PACKAGE = "motionrt"
OLDEST = (3, 10)
CARRIED = Path(__file__).parent / "wheel"
"""Where the add-on's zip may carry a wheel of motionrt; make_extension.py puts it there."""


class InstallError(RuntimeError):
    """pip could not install; the message is its last words."""


def folder() -> Path:
    """Where the package goes: one folder per Python version, so that a newer Blender gets its own."""
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    return Path(bpy.utils.user_resource("DATAFILES", path=f"motionrt/{version}"))


def add_to_path() -> None:
    """Let Python find what is installed there, before anything of the same name elsewhere."""
    place = str(folder())
    if Path(place).is_dir() and place not in sys.path:
        sys.path.insert(0, place)
        importlib.invalidate_caches()


def available() -> bool:
    """Whether motionrt can be imported."""
    return importlib.util.find_spec(PACKAGE) is not None


def install(source: str = PACKAGE) -> None:
    """Install or update the package: a name on PyPI, a wheel, or a folder with the sources.

    By its plain name it is the wheel that the add-on carries, where it carries one.

    Raises:
        InstallError: Blender's Python is too old, pip is missing or failed.
    """
    if sys.version_info < OLDEST:
        raise InstallError(
            f"motionrt needs Python 3.10; this Blender has {sys.version.split()[0]}: use Blender 3.1 or newer"
        )
    folder().mkdir(parents=True, exist_ok=True)
    _pip("install", "--upgrade", "--no-warn-script-location", "--target", str(folder()), _found(source))
    add_to_path()
    importlib.invalidate_caches()
    if old := _older_numpy():
        raise InstallError(f"installed, but NumPy {old} was loaded before: restart Blender once")


def _found(source: str) -> str:
    carried = sorted(CARRIED.glob(f"{PACKAGE}-*.whl"))
    return str(carried[-1]) if carried and source in {"", PACKAGE} else source or PACKAGE


def _pip(*arguments: str) -> None:
    if importlib.util.find_spec("pip") is None:
        _run("-m", "ensurepip", "--user")
    _run("-m", "pip", "--disable-pip-version-check", *arguments)


def _run(*arguments: str) -> None:
    done = subprocess.run([_python(), *arguments], capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode:
        lines = [line for line in (done.stderr or done.stdout).splitlines() if line.strip()]
        raise InstallError(" ".join(lines[-2:]) or f"{arguments} failed with {done.returncode}")


def _python() -> str:
    """Blender's own interpreter."""
    name = f"python{sys.version_info.major}.{sys.version_info.minor}"
    places = [Path(sys.executable), *(Path(sys.prefix) / "bin" / part for part in (name, "python3", "python.exe"))]
    return next((str(place) for place in places if "python" in place.name.lower() and place.exists()), name)


def _older_numpy() -> str | None:
    """The version of a NumPy that Blender had loaded before, where motionrt's own is another."""
    loaded = sys.modules.get("numpy")
    if loaded is None or str(getattr(loaded, "__file__", "")).startswith(str(folder())):
        return None
    return str(loaded.__version__) if tuple(map(int, loaded.__version__.split(".")[:2])) < (1, 26) else None
