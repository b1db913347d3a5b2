"""How many requests, how long, how many failed: in the text format of Prometheus."""

from __future__ import annotations

import threading
from collections import Counter

_BOUNDS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0)  # seconds


class Metrics:
    """Counters of a process. May be used from several threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._requests: Counter[tuple[str, int]] = Counter()
        self._seconds: Counter[str] = Counter()
        self._within: Counter[tuple[str, float]] = Counter()
        self.active = 0
        self.streams = 0
        self.frames = 0

    def note(self, route: str, status: int, seconds: float) -> None:
        """A request that was answered."""
        with self._lock:
            self._requests[route, status] += 1
            self._seconds[route] += seconds  # type: ignore[assignment]  # a Counter adds floats, too
            for bound in _BOUNDS:
                self._within[route, bound] += seconds <= bound

    def text(self) -> str:
        """All of it, one number a line."""
        with self._lock:
            lines = ["# TYPE motionrt_requests_total counter"]
            for (route, status), count in sorted(self._requests.items()):
                lines.append(f'motionrt_requests_total{{route="{route}",status="{status}"}} {count}')
            lines.append("# TYPE motionrt_request_seconds histogram")
            for route in sorted(self._seconds):
                total = sum(count for (name, _), count in self._requests.items() if name == route)
                for bound in _BOUNDS:
                    within = self._within[route, bound]
                    lines.append(f'motionrt_request_seconds_bucket{{route="{route}",le="{bound:g}"}} {within}')
                lines.append(f'motionrt_request_seconds_bucket{{route="{route}",le="+Inf"}} {total}')
                lines.append(f'motionrt_request_seconds_sum{{route="{route}"}} {self._seconds[route]:.6f}')
                lines.append(f'motionrt_request_seconds_count{{route="{route}"}} {total}')
            for name, value in (("active_requests", self.active), ("walk_streams", self.streams)):
                lines += [f"# TYPE motionrt_{name} gauge", f"motionrt_{name} {value}"]
            lines += ["# TYPE motionrt_walk_frames_total counter", f"motionrt_walk_frames_total {self.frames}"]
        return "\n".join(lines) + "\n"
