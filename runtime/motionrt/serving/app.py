"""The HTTP service: the verbs of the runtime as JSON and files, described by OpenAPI at ``/openapi.json``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from fastapi import FastAPI, Query, Request, Response, WebSocket
from fastapi.concurrency import run_in_threadpool
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, PlainTextResponse

import motionrt
from motionrt.errors import (
    ChecksumError,
    GalleryError,
    GalleryNotFoundError,
    ModelFileError,
    ModelNotFoundError,
    MotionRTError,
)
from motionrt.motion import Motion
from motionrt.retrieval import Filter
from motionrt.serving.asking import Caption, Compose, Format, Generate, Hits, Retrieve, Similar
from motionrt.serving.desk import Desk, read_motion, written
from motionrt.serving.gate import Gate, TooLargeError
from motionrt.serving.metrics import Metrics
from motionrt.serving.walking import walk

NOT_FOUND, OURS = (GalleryNotFoundError,), (ModelFileError, ModelNotFoundError, ChecksumError, GalleryError)
MEDIA = {"glb": "model/gltf-binary", "gltf": "model/gltf+json", "vrma": "model/gltf-binary", "bvh": "text/plain"}
FILE: dict[int | str, dict[str, Any]] = {200: {"content": {"application/octet-stream": {}}, "description": "the file"}}


def make_app(desk: Desk, *, token: str | None, origins: Sequence[str] = (), active: int = 2) -> Gate:
    """The ASGI application.

    Args:
        desk: the runtime and the galleries that are served.
        token: what clients must send as ``Authorization: Bearer TOKEN``; None lets everybody in who reaches the port.
        origins: web pages that may ask.
        active: requests that are worked on at once.
    """
    metrics = Metrics()
    app = FastAPI(title="motionrt", version=motionrt.__version__, docs_url=None, redoc_url=None)
    app.add_exception_handler(MotionRTError, _refused)
    app.add_exception_handler(RequestValidationError, _misread)
    _add_searching(app, desk)
    _add_making(app, desk)

    @app.get("/health", summary="whether it serves")
    async def health() -> dict[str, str]:
        return {"status": "ok", "version": motionrt.__version__}

    @app.get("/metrics", response_class=PlainTextResponse, summary="counters, as Prometheus reads them")
    async def counters() -> str:
        return metrics.text()

    @app.websocket("/v1/walk")
    async def stream(socket: WebSocket) -> None:
        await walk(socket, desk.runtime, metrics)

    return Gate(app, token, origins, active, metrics)


def _add_searching(app: FastAPI, desk: Desk) -> None:
    @app.get("/v1/galleries", summary="the galleries that are served")
    def galleries() -> list[dict[str, Any]]:
        found = {name: desk.gallery(name) for name in desk.galleries}
        return [{"name": name, "clips": len(one), "windows": len(one.windows)} for name, one in found.items()]

    @app.post("/v1/retrieve", response_model=Hits, summary="motions that fit a text")
    def retrieve(asked: Retrieve) -> dict[str, Any]:
        filters = Filter(asked.where, asked.min_s, asked.max_s, asked.folder, tuple(asked.tags), asked.words)
        return desk.retrieve(
            asked.text, asked.k, asked.gallery, per_clip=asked.per_clip, anyway=asked.anyway, filters=filters
        )

    @app.post("/v1/similar", response_model=Hits, summary="clips like another one")
    def similar(asked: Similar) -> dict[str, Any]:
        return desk.similar(asked.clip, asked.k, asked.gallery)

    @app.get("/v1/motion", responses=FILE, response_class=Response, summary="a clip, or a part of it, as a file")
    def motion(
        clip: str,
        start_s: float | None = None,
        end_s: float | None = None,
        gallery: str | None = None,
        format: Format = "glb",  # noqa: A002 - what clients call it
    ) -> Response:
        return _file(desk.motion(clip, start_s, end_s, gallery), format)

    @app.post("/v1/describe", response_model=list[Caption], summary="captions for a motion file, which is the body")
    async def describe(
        request: Request, name: str, k: Annotated[int, Query(ge=1, le=1000)] = 5
    ) -> list[dict[str, Any]]:
        content = await request.body()
        return await run_in_threadpool(lambda: desk.describe(read_motion(name, content), k))


def _add_making(app: FastAPI, desk: Desk) -> None:
    @app.post("/v1/generate", responses=FILE, response_class=Response, summary="a motion of a text")
    def generate(asked: Generate) -> Response:
        made = desk.runtime.generate(
            asked.text, asked.seconds, seed=asked.seed, loop=asked.loop, in_place=asked.in_place
        )
        return _file(made, asked.format)

    @app.post("/v1/compose", responses=FILE, response_class=Response, summary="one motion of several layers")
    def compose(asked: Compose) -> Response:
        layers = [layer.model_dump() for layer in asked.layers]
        return _file(desk.compose(layers, asked.seconds, asked.seed), asked.format)

    @app.post("/v1/convert", responses=FILE, response_class=Response, summary="a motion file, the body, as another")
    async def convert(
        request: Request,
        name: str,
        format: Format,  # noqa: A002 - what clients call it
        fps: Annotated[float | None, Query(gt=0, le=1000)] = None,
    ) -> Response:
        content = await request.body()
        return await run_in_threadpool(lambda: _file(_resampled(read_motion(name, content), fps), format))


def _resampled(motion: Motion, fps: float | None) -> Motion:
    return motion if fps is None else motion.resample(fps)


def _file(motion: Motion, form: str) -> Response:
    headers = {"X-Motion-Frames": str(motion.frames), "X-Motion-Fps": f"{motion.fps:g}"}
    return Response(written(motion, form), media_type=MEDIA.get(form, "application/octet-stream"), headers=headers)


async def _refused(_: Request, error: Exception) -> JSONResponse:
    """An error of motionrt: what the client did wrong in its words; what is wrong here without names of files."""
    kind = type(error).__name__
    if isinstance(error, OURS) and not isinstance(error, NOT_FOUND):
        return JSONResponse({"error": {"type": kind, "message": "the server cannot use its models or galleries"}}, 500)
    status = 404 if isinstance(error, NOT_FOUND) else 413 if isinstance(error, TooLargeError) else 422
    return JSONResponse({"error": {"type": kind, "message": _public(str(error))}}, status)


async def _misread(_: Request, error: Exception) -> JSONResponse:
    """A request that is not as its description says: which field, and what is wrong with it."""
    told = error.errors() if isinstance(error, RequestValidationError) else []
    words = "; ".join(f"{'.'.join(str(part) for part in one['loc'][1:])}: {one['msg']}" for one in told[:5])
    return JSONResponse({"error": {"type": "InvalidInputError", "message": words[:1000]}}, 422)


def _public(message: str) -> str:
    """A message without the folder that an uploaded file was put into."""
    return " ".join("the file" if "motionrt-" in word and "/" in word else word for word in message.split(" "))
