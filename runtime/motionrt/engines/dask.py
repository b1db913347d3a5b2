"""Batches of work on a Dask cluster: no more at once than its workers take, and again where one dies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

from motionrt.engines.batches import Batch, Done, index_batch
from motionrt.engines.packages import package
from motionrt.errors import EngineError, InvalidInputError
from motionrt.retrieval.records import Skipped
from motionrt.untrusted.words import shown

SCHEMES = ("dask", "tcp", "tls")
_AHEAD = 2  # batches that wait for each thread of the cluster
_PATIENCE_S = 30  # for the scheduler, and for its first worker


def check_scheduler(address: str) -> None:
    """Refuse an address that is none of a Dask scheduler.

    Raises:
        InvalidInputError: no such kind of address, ``ray://`` among them.
    """
    if address.partition("://")[0] not in SCHEMES:
        raise InvalidInputError(
            f"{shown(address)} is no Dask scheduler, and others, such as Ray, are not known: dask://host:8786"
        )


def on_dask(address: str, batches: Iterable[Batch]) -> Iterator[tuple[Batch, Done]]:
    """What becomes of the batches, in the order in which they are done.

    A batch whose worker dies is given to another one. A batch that fails is tried again file by file, and a file that
    fails alone is a failure of its own.

    Args:
        address: of the scheduler, ``dask://host:8786``.
        batches: taken as the cluster gets done with those before.

    Raises:
        EngineError: the cluster cannot be reached, or the store cannot be from there.
        MissingDependencyError: distributed is not installed.
    """
    distributed = package("distributed", "a cluster", "cluster")
    with _client(distributed, address) as client:
        waiting, of = iter(batches), {}
        running = distributed.as_completed(loop=client.loop)

        def submit(batch: Batch) -> None:
            future = client.submit(index_batch, batch, pure=False)
            of[future.key] = batch
            running.add(future)

        for batch in islice(waiting, _AHEAD * max(1, sum(client.nthreads().values()))):
            submit(batch)
        for future in running:
            batch = of.pop(future.key)
            done = _done(future, batch)
            if done is None:
                for one in batch.single():
                    submit(one)
                continue
            yield batch, done
            for following in islice(waiting, 1):
                submit(following)


def _done(future: Any, batch: Batch) -> Done | None:
    """What became of a batch; None where its files are to be tried one by one."""
    if future.cancelled():
        raise EngineError("the cluster's scheduler went away; give the command again, and it goes on")
    error = future.exception()
    if error is None:
        done: Done = future.result()
        return done
    if isinstance(error, EngineError):
        raise error
    if len(batch.files) > 1:
        return None
    reason = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    return Done(failures=(Skipped(batch.files[0][0], f"cannot be indexed: {reason}"),))


def _client(distributed: Any, address: str) -> Any:
    place = address.replace("dask://", "tcp://", 1)
    try:
        client = distributed.Client(place, timeout=_PATIENCE_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise EngineError(f"no Dask scheduler answers at {address}: {error}") from error
    try:
        client.wait_for_workers(1, timeout=_PATIENCE_S)
    except TimeoutError as error:
        client.close()
        raise EngineError(f"the Dask scheduler at {address} has no worker; start one: dask worker {place}") from error
    return client
