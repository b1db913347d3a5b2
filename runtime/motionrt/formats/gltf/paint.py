"""Which colour every triangle of a GLB file has: its material's, or that of its texture in the middle of it."""

from __future__ import annotations

import base64
import io
from hashlib import sha256
from importlib import import_module
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.formats.gltf.container import Json
from motionrt.formats.gltf.document import GlbDocument
from motionrt.limits import limits

Bytes = npt.NDArray[np.uint8]
_SIDE = 512  # pixels of a texture that are looked at
_LARGEST = 1 << 26  # pixels of a texture that is read
_DENSE = 20  # pixels for every byte of a picture that is what it seems; more count against the limit of pixels
_CLEAR = 64  # of 255; what is clearer is not there
_GREY = (200, 204, 210)


class Paint:
    """Colours of the primitives of a document.

    Textures need Pillow; without it, and where one cannot be read, the material's own colour stands.

    Args:
        document: of the meshes.
    """

    def __init__(self, document: GlbDocument) -> None:
        self._document, self._images = document, dict[bytes, Bytes | None]()
        self._left = limits().pixels

    def of(self, primitive: Json, faces: Any, vertices: int) -> tuple[Bytes, npt.NDArray[np.bool_]]:
        """Colours ``(T, 3)`` of triangles ``(T, 3)``, and which of them can be seen at all ``(T,)``."""
        material = _item(self._document.json, "materials", primitive.get("material"))
        base = material.get("pbrMetallicRoughness", {})
        factor = np.clip(np.array(base.get("baseColorFactor", [1, 1, 1, 1]), np.float64).reshape(-1)[:4], 0, 1)
        tint = 255 * factor[:3] ** (1 / 2.2)  # factors are linear
        seen = np.ones(len(faces), bool)
        link = base.get("baseColorTexture", {})
        image = self._image(link.get("index"))
        place = primitive.get("attributes", {}).get(f"TEXCOORD_{link.get('texCoord', 0)}")
        if image is None or place is None:
            plain = tint if material else np.array(_GREY)
            return np.broadcast_to(np.round(plain).astype(np.uint8), (len(faces), 3)), seen
        where = self._document.arrays.read(place, "a texture")
        if where.ndim != 2 or len(where) != vertices or where.shape[1] != 2:
            return np.broadcast_to(np.round(tint).astype(np.uint8), (len(faces), 3)), seen
        middle = where[faces].mean(axis=1) % 1.0
        pixel = (middle * image.shape[1::-1]).astype(np.int64)
        found = image[np.minimum(pixel[:, 1], image.shape[0] - 1), np.minimum(pixel[:, 0], image.shape[1] - 1)]
        if material.get("alphaMode", "OPAQUE") != "OPAQUE":
            seen = found[:, 3] >= _CLEAR
        return np.round(found[:, :3] * tint / 255).astype(np.uint8), seen

    def _image(self, texture: object) -> Bytes | None:
        """``(H, W, 4)`` the pixels of a texture, made smaller."""
        source = _item(self._document.json, "textures", texture).get("source")
        if not isinstance(source, int):
            return None
        content = self._content(_item(self._document.json, "images", source))
        if content is None:
            return None
        mark = sha256(content).digest()  # many images may be one picture
        if mark not in self._images:
            self._images[mark] = self._decoded(content)
        return self._images[mark]

    def _decoded(self, content: bytes) -> Bytes | None:
        try:
            pillow = import_module("PIL.Image")
        except ImportError:
            return None
        try:
            with pillow.open(io.BytesIO(content), formats=("PNG", "JPEG", "WEBP")) as opened:
                if not self._affordable(opened.width * opened.height, len(content)):
                    return None
                opened.draft("RGB", (_SIDE, _SIDE))
                opened.thumbnail((_SIDE, _SIDE))
                return np.asarray(opened.convert("RGBA"))
        except Exception:  # noqa: BLE001  Pillow raises of many kinds for damaged pictures, and no colour ends a figure
            return None

    def _affordable(self, pixels: int, size: int) -> bool:
        """Whether a picture may be unpacked; those of many more pixels than bytes share one limit."""
        if pixels > _LARGEST or (pixels > _DENSE * size and pixels > self._left):
            return False
        self._left -= pixels if pixels > _DENSE * size else 0
        return True

    def _content(self, image: Json) -> bytes | None:
        uri = image.get("uri")
        if isinstance(uri, str) and uri.startswith("data:") and ";base64," in uri[:100]:
            try:
                return base64.b64decode(uri.split(",", 1)[1])
            except ValueError:
                return None
        view = image.get("bufferView")
        return None if view is None else self._document.arrays.view(view, "a texture")


def _item(document: Json, key: str, index: object) -> Json:
    entries = document.get(key, [])
    if isinstance(index, int) and not isinstance(index, bool) and 0 <= index < len(entries):
        entry = entries[index]
        return entry if isinstance(entry, dict) else {}
    return {}
