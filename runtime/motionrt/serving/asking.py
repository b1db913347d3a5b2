"""What requests hold, as the OpenAPI description shows it; the runtime checks what a schema cannot say."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

Format = Literal["glb", "gltf", "vrma", "bvh", "npz"]


class Asked(BaseModel):
    """A request: a field that is not known is a mistake."""

    model_config = ConfigDict(extra="forbid")


class Retrieve(Asked):
    """Motions that fit a text."""

    text: str = Field(min_length=1, examples=["a person walks in a circle"])
    k: int = Field(10, ge=1, le=1000, description="how many hits")
    gallery: str | None = Field(None, description="by name; the first that is served where none is given")
    per_clip: bool = Field(True, description="only the best span of every clip")
    anyway: bool = Field(False, description="search even where no word of the text is known")
    where: str | None = Field(None, description="a condition on attributes", examples=["turn > 60 and speed < 1.5"])
    min_s: float | None = Field(None, description="least duration of a clip, seconds")
    max_s: float | None = Field(None, description="most duration of a clip, seconds")
    folder: str | None = Field(None, description="below this folder of the library")
    tags: list[str] = Field(default_factory=list, description="tags of the clip")
    words: str | None = Field(None, description="words of captions, tags or file names, all of them")


class Similar(Asked):
    """Clips like one of the gallery's own."""

    clip: str
    k: int = Field(10, ge=1, le=1000)
    gallery: str | None = None


class Hit(BaseModel):
    """One answer; times are seconds of the clip."""

    rank: int
    score: float
    clip: str
    start_s: float
    end_s: float
    text: str | None
    cosine: float | None
    agreement: float | None


class Hits(BaseModel):
    """Answers, best first, and what there is to say about them."""

    hits: list[Hit]
    notice: str | None


class Generate(Asked):
    """A motion of a text."""

    text: str = Field(min_length=1)
    seconds: float = Field(4.0, gt=0, le=10)
    seed: int | None = Field(None, ge=0)
    loop: bool = False
    in_place: bool = False
    format: Format = "glb"


class Layer(Asked):
    """What moves a part of the body: a text or a clip."""

    text: str | None = None
    clip: str | None = None
    gallery: str | None = None
    parts: list[str] | None = Field(None, description="body parts, as in 'right arm'; found where none is given")


class Compose(Asked):
    """One motion of several layers."""

    layers: list[Layer] = Field(min_length=2, max_length=6)
    seconds: float | None = Field(None, gt=0, le=60)
    seed: int | None = Field(None, ge=0)
    format: Format = "glb"


class Caption(BaseModel):
    """A caption that fits, and the window that it fits best."""

    rank: int
    score: float
    text: str
    start_s: float
    end_s: float


class Aim(Asked):
    """Where a streamed character shall go: metres, and radians from +Z towards +X."""

    x: float
    z: float
    heading: float = 0.0
