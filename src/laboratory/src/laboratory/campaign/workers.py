"""Who plays: processes of this machine, or those of a scheduler of Dask."""

import logging
import os
import signal
import threading
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any, Iterator

import dask
from distributed import Client, LocalCluster

from laboratory.errors import WorkersError

# A mission is lost for good when so many workers have died of it.
MAX_WORKER_DEATHS = 3
# Workers are renewed now and then, so that whatever they leak stays small.
LIFETIME, LIFETIME_STAGGER = "60 minutes", "10 minutes"
CONNECT_TIMEOUT = 20
# Dask has workers give back what they free at once, only to ask for it anew: 20 000 page faults a mission.
MALLOC_ENVIRONMENT = {"MALLOC_TRIM_THRESHOLD_": 2**27, "MALLOC_MMAP_THRESHOLD_": 2**26, "MALLOC_ARENA_MAX": 1}


@dataclass(frozen=True)
class Workers:
    """``count``: processes here, 0: one for each core. ``scheduler``: the address of one, instead of them."""

    count: int = 0
    scheduler: str = ""

    @contextmanager
    def client(self) -> Iterator[Client]:
        """A connection to them, which is closed with them. Raises WorkersError."""
        dask.config.set(
            {
                "distributed.scheduler.worker-saturation": 1.0,
                "distributed.scheduler.allowed-failures": MAX_WORKER_DEATHS - 1,
                "distributed.worker.daemon": True,
                "distributed.worker.profile.enabled": False,
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
            cluster = LocalCluster(
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
        try:
            with Client(cluster, set_as_default=False) as client:
                yield client
        finally:
            with suppress(Exception):  # of processes that are ended anyway
                cluster.close(timeout=10)

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
    """How many workers there are now."""
    return len(client.scheduler_info(n_workers=-1)["workers"])


@contextmanager
def _ignoring_sigint() -> Iterator[None]:
    """Processes that are started meanwhile do not hear Ctrl-C, which this one hears for them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
