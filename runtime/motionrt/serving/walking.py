"""A walking character over a WebSocket: a frame a message, at 30 fps or as fast as the client takes them."""

from __future__ import annotations

import asyncio
import json
import time
from typing import Any

from fastapi import WebSocket, WebSocketDisconnect
from fastapi.concurrency import run_in_threadpool
from pydantic import ValidationError

from motionrt.errors import MotionRTError
from motionrt.limits import limits
from motionrt.locomotion.goal_frame import Goal
from motionrt.motion import SMPL24, Motion
from motionrt.motion.rotations import matrix_to_quaternion
from motionrt.runtime import Runtime
from motionrt.serving.asking import Aim
from motionrt.serving.metrics import Metrics

FPS = 30.0
_BUSY, _WRONG = 4503, 4400  # how a WebSocket is closed


async def walk(socket: WebSocket, runtime: Runtime, metrics: Metrics) -> None:
    """Serve one client: it sends goals as JSON, first one and later others, and gets frames until it goes away.

    The first message is ``{"joints": [...], "parents": [...], "fps": 30}``; each frame is ``{"frame": n,
    "root": [x, y, z], "rotations": [[w, x, y, z], ...]}``, metres and local rotations. ``?paced=false`` sends frames
    without waiting.
    """
    await socket.accept()
    if metrics.streams >= limits().windows:
        await socket.close(_BUSY, f"{metrics.streams} streams are open; come back later")
        return
    metrics.streams += 1
    try:
        await _serve(socket, runtime, metrics, paced=socket.query_params.get("paced") != "false")
    except (WebSocketDisconnect, RuntimeError):  # the client has gone
        pass
    except (ValidationError, MotionRTError, ValueError) as error:
        await socket.close(_WRONG, " ".join(str(error).split())[:100])
    finally:
        metrics.streams -= 1


async def _serve(socket: WebSocket, runtime: Runtime, metrics: Metrics, *, paced: bool) -> None:
    frames = runtime.stream(_goal(await socket.receive_text()))
    await socket.send_json({"joints": SMPL24.names, "parents": list(SMPL24.parents), "fps": FPS})
    goals: asyncio.Queue[Goal] = asyncio.Queue()
    listening = asyncio.create_task(_listen(socket, goals))
    began, number = time.perf_counter(), 0
    try:
        while not listening.done():
            goal = goals.get_nowait() if not goals.empty() and number else None
            motion = await run_in_threadpool(frames.send, goal)  # None is the same goal as before
            await socket.send_text(json.dumps({"frame": number, **_frame(motion)}))
            number += 1
            metrics.frames += 1
            ahead = began + number / FPS - time.perf_counter()
            await asyncio.sleep(max(ahead, 0.0) if paced else 0.0)
        listening.result()
    finally:
        listening.cancel()
        frames.close()


async def _listen(socket: WebSocket, goals: asyncio.Queue[Goal]) -> None:
    while True:
        goals.put_nowait(_goal(await socket.receive_text()))


def _goal(text: str) -> Goal:
    aim = Aim.model_validate_json(text)
    return Goal(aim.x, aim.z, aim.heading)


def _frame(motion: Motion) -> dict[str, Any]:
    rotations = matrix_to_quaternion(motion.rotations[0])
    return {
        "root": [round(float(metres), 5) for metres in motion.root[0]],
        "rotations": [[round(float(part), 5) for part in quaternion] for quaternion in rotations],
    }
