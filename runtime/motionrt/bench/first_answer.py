"""A fresh process up to its first embedded text: prints how long the import took, and the most memory held."""

from __future__ import annotations

import json
import sys
import time


def main() -> int:
    """``first_answer.py '{"models": null, "threads": 1}'``."""
    started = time.perf_counter()
    from motionrt.runtime import Runtime

    import_s = time.perf_counter() - started
    Runtime(**json.loads(sys.argv[1])).embed_text("a person walks in a circle")
    print(json.dumps({"import_s": import_s, "peak_mb": peak_mb()}), flush=True)
    return 0


def peak_mb() -> float | None:
    """The most memory this process has held, in MB; ``None`` where the system does not say."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


if __name__ == "__main__":
    sys.exit(main())
