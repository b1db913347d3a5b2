"""Where the models are: in a folder that the caller names, else in the package, else in the checkout."""

from __future__ import annotations

from pathlib import Path

from motionrt.errors import ModelFileError
from motionrt.models.manifest import MANIFEST_NAME

_PACKAGE = Path(__file__).resolve().parent.parent


def find_manifest(models: str | Path | None = None) -> Path:
    """The path of the manifest.

    Args:
        models: a folder with ``models_manifest.yaml``, or that file; None looks into the installed
            package, then into the repository around it.

    Raises:
        ModelFileError: there is none; says where it was looked for.
    """
    places = [_manifest_of(Path(models))] if models is not None else list(_default_places())
    for place in places:
        if place.is_file():
            return place
    looked = " and ".join(str(place) for place in places)
    advice = (
        "give a folder that has one" if models is not None else "install motionrt again, or name a folder of models"
    )
    raise ModelFileError(f"no {MANIFEST_NAME}: looked for {looked}; {advice}")


def _manifest_of(models: Path) -> Path:
    return models if models.suffix in (".yaml", ".yml") else models / MANIFEST_NAME


def _default_places() -> tuple[Path, ...]:
    checkout = _PACKAGE.parent.parent  # <repository>/runtime/motionrt
    return _PACKAGE / "_assets" / MANIFEST_NAME, checkout / MANIFEST_NAME
