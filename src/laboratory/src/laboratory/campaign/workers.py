"""Worker processes of a campaign: on this machine, or those of a Dask scheduler."""

import logging
import os
import signal
import threading
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any, Iterator

import dask
from distributed import Client, LocalCluster
from distributed.utils import get_mp_context

from laboratory.errors import WorkersError

# A run is recorded as an error after it has killed this many workers.
MAX_WORKER_DEATHS = 3
# Workers are replaced regularly to bound the effect of memory leaks.
LIFETIME, LIFETIME_STAGGER = "60 minutes", "10 minutes"
# Seconds.
CONNECT_TIMEOUT = 20
# By default Dask makes malloc return freed memory at once, which costs 20 000 page faults a run.
MALLOC_ENVIRONMENT = {"MALLOC_TRIM_THRESHOLD_": 2**27, "MALLOC_MMAP_THRESHOLD_": 2**26, "MALLOC_ARENA_MAX": 1}
# By default Dask reads delays of event loops 50 times a second, and memory 10 times, which interrupts runs.
CHECK_INTERVALS = dict.fromkeys(
    (
        "distributed.admin.tick.interval",
        "distributed.admin.system-monitor.interval",
        "distributed.worker.memory.monitor-interval",
    ),
    "1s",
)
# Workers are forked from a process that has imported these once.
PRELOADED = ("distributed", "laboratory.runner")


@dataclass(frozen=True)
class Workers:
    """Which worker processes a campaign uses.

    Attributes:
        count: Number of processes on this machine; 0: one for each core.
        scheduler: Address of a Dask scheduler, whose workers are used instead.
    """

    count: int = 0
    scheduler: str = ""

    @contextmanager
    def client(self) -> Iterator[Client]:
        """Start or connect to the workers for the duration of the context.

        Raises:
            WorkersError: No scheduler with workers answers at the address.
        """
        dask.config.set(
            {
                "distributed.scheduler.worker-saturation": 1.0,
                "distributed.scheduler.allowed-failures": MAX_WORKER_DEATHS - 1,
                "distributed.worker.daemon": True,
                "distributed.worker.multiprocessing-method": "forkserver",
                "distributed.worker.profile.enabled": False,
                **CHECK_INTERVALS,
                **{
                    f"distributed.nanny.pre-spawn-environ.{key}": value
                    for key, value in MALLOC_ENVIRONMENT.items()
                },
            }
        )
        for name in ("distributed", "distributed.nanny", "distributed.scheduler", "distributed.worker"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
        with self._remote_scheduler() if self.scheduler else self._local_cluster() as client:
            yield client

    @contextmanager
    def _local_cluster(self) -> Iterator[Client]:
        with _ignoring_sigint():
            cluster = self._start_cluster()
        try:
            with Client(cluster, set_as_default=False) as client:
                yield client
        finally:
            with suppress(Exception):  # the processes are terminated in any case
                cluster.close(timeout=10)

    def _start_cluster(self, attempts: int = MAX_WORKER_DEATHS) -> LocalCluster:
        """Start the processes, again if one dies while it starts."""
        get_mp_context().set_forkserver_preload([*PRELOADED])
        try:
            return LocalCluster(
                n_workers=self.count or len(os.sched_getaffinity(0)),
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                worker_dashboard_address="127.0.0.1:0",
                silence_logs=logging.CRITICAL,
                lifetime=LIFETIME,
                lifetime_stagger=LIFETIME_STAGGER,
                lifetime_restart=True,
            )
        except Exception as error:  # Dask's exceptions have no common class
            if attempts <= 1:
                text = str(error) or type(error).__name__
                raise WorkersError(f"the worker processes cannot be started: {text}") from None
        return self._start_cluster(attempts - 1)

    @contextmanager
    def _remote_scheduler(self) -> Iterator[Client]:
        try:
            client = Client(self.scheduler, timeout=CONNECT_TIMEOUT, set_as_default=False)
            client.wait_for_workers(1, timeout=CONNECT_TIMEOUT)
        except (OSError, ValueError) as error:
            raise WorkersError(f"{self.scheduler}: no scheduler with workers answers ({error})") from None
        with client:
            yield client


def worker_count(client: Any) -> int:
    """Return the current number of workers."""
    return len(client.scheduler_info(n_workers=-1)["workers"])


@contextmanager
def _ignoring_sigint() -> Iterator[None]:
    """Start child processes that ignore SIGINT: only this process handles Ctrl-C."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
