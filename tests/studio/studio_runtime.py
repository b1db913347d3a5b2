"""A runtime without models: a gallery of gaits, generation that answers with a gait, characters that walk straight."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from fake_character_models import FakeCharacterModels
from motions import standing, walking

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.retrieval import Description, Hit
from motionrt.runtime import Runtime


class SmallGallery:
    clips = ("a person walks", "a person walks in a circle", "a person stands", "a person hurries")

    def motion(self, hit: Hit) -> Motion:
        made = {"a person stands": standing(60), "a person walks in a circle": walking(60, turn=0.6)}
        return made.get(hit.id, walking(60, speed=1.8 if "hurries" in hit.id else 1.2))


class StudioRuntime(Runtime):
    @cached_property
    def character_models(self) -> Any:  # type: ignore[override]
        return FakeCharacterModels()

    def gallery(self, gallery: object = None) -> Any:
        return SmallGallery()

    def retrieve(self, text: str, k: int = 10, gallery: object = None, **_: object) -> Any:  # type: ignore[override]
        if "unicorn" in text:
            raise InvalidInputError("no unicorns in this gallery")
        return [Hit(i + 1, 0.9 - i / 10, name, None, 0.0, 3.0, name) for i, name in enumerate(SmallGallery.clips)]

    def generate(  # type: ignore[override]
        self, text: str = "", seconds: float = 4.0, *, n: int | None = None, **_: object
    ) -> Any:
        made = walking(round(20 * seconds))
        return made if n is None else [made] * n

    def describe(self, *_: object, **__: object) -> list[Description]:
        return [Description(1, 0.8, "somebody walks", 0.0, 3.0)]
