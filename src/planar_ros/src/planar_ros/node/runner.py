"""The manners of a node: how it starts, fails and ends."""

import gc
import logging
import os
import queue
import sys
import threading
from typing import Any, Callable, List

import rospy
from rosgraph import get_master_uri
from rospy.impl.paramserver import get_param_server_cache

from planar import PlanarError
from planar_ros.node.connections import extend_listen_backlog, merge_publisher_updates
from planar_ros.node.entry import use_one_blas_thread
from supervision.interruption import on_signals
from supervision.streams import ignore_write_errors

# Longer than any node needs to end in order.
SHUTDOWN_SECONDS = 5.0
# The exit code of a node one of whose threads has died: EX_SOFTWARE of sysexits.h.
THREAD_DIED = 70
# Whether lines of the log leave out which topics the node has, by rospy.
LOG_WITHOUT_TOPICS = "/rosout_disable_topics_generation"
# What rospy raises where somebody publishes while it ends.
CLOSED = ("publish() to a closed topic", "topic was closed during publish()")


def run(node_name: str, start: Callable[[], object]) -> None:
    """Names the node, calls ``start`` and stays until shutdown; what ``start`` returns is kept alive.

    A PlanarError during the start is a user's mistake: one line on stderr, exit code 2.
    """
    shut_down_on_signals()
    ignore_write_errors()
    use_one_blas_thread()
    try:
        init_node(node_name)
    except OSError as error:
        print(f"[{node_name}] error: no ROS master at {get_master_uri()} ({error})", file=sys.stderr)
        sys.exit(2)
    is_ending, is_over = threading.Event(), threading.Event()
    rospy.on_shutdown(is_ending.set)
    failures: List[str] = []
    threading.excepthook = _ending_the_node(is_ending, failures)
    logging.getLogger("rosout").addFilter(lambda record: not (is_ending.is_set() and _is_of_closing(record)))
    # Called after rospy's own hooks: then the master and all peers have been told.
    rospy.core.add_shutdown_hook(lambda _reason: is_over.set())
    try:
        node = start()
        is_over.wait()
        del node
    except PlanarError as error:
        fail(str(error))
    except Exception:
        if not is_ending.is_set():  # else its topics were closed while it still worked
            raise
        is_over.wait()
    finally:
        # The interpreter would look for garbage among all of numba first, which takes a third of a second.
        gc.freeze()
    if failures:
        sys.exit(THREAD_DIED)


def init_node(name: str, **options: Any) -> None:
    """Makes this process a node, which hears all publishers; the master forgets it once it has ended.

    ``options``: rospy's; signals are left to the caller.

    rospy would subscribe to a parameter with each line of the log, and never unsubscribe: the master would
    take the next node of that name for a second one, and shut down who has the first one's port by then.
    """
    extend_listen_backlog()
    merge_publisher_updates()
    rospy.init_node(name, **{"disable_signals": True, **options})
    get_param_server_cache().set(LOG_WITHOUT_TOPICS, rospy.get_param(LOG_WITHOUT_TOPICS, False))


def shut_down_on_signals(goes_on: bool = False) -> None:
    """From now on signals shut the node down, in a thread; to be called before ``init_node``.

    rospy would do it in the signal's handler, on top of whatever the main thread is at, and wait for ever for
    a lock that this holds, as while it publishes. ``goes_on``: the process has more to do than to be a node,
    and may take its time for that afterwards.
    """
    received: queue.SimpleQueue[int] = queue.SimpleQueue()

    def shut_down():
        number = received.get()
        watchdog = _end_within(SHUTDOWN_SECONDS, 128 + number)
        rospy.signal_shutdown(f"signal {number}")
        if goes_on:
            watchdog.cancel()

    threading.Thread(target=shut_down, daemon=True).start()
    on_signals(lambda number, _frame: received.put(number))


def fail(text: str, exit_code: int = 2) -> None:
    """Says why on stderr, in one line, and ends the node."""
    print(f"[{rospy.get_name()}] error: {text}", file=sys.stderr, flush=True)
    rospy.signal_shutdown(text)
    sys.exit(exit_code)


def _is_of_closing(record: logging.LogRecord) -> bool:
    """Whether a callback came upon a closed topic: rospy closes them before it says that it ends."""
    return any(words in record.getMessage() for words in CLOSED)


def _ending_the_node(
    is_ending: threading.Event, failures: List[str]
) -> Callable[[threading.ExceptHookArgs], None]:
    """A hook by which a thread that dies takes the node along, whose last words are the reason.

    Half a node would be worse than none: nobody would start it anew. ``failures`` receives the reason. Topics
    that are closed under a thread at the end are no reason.
    """
    tell_all = threading.excepthook

    def end(failure: threading.ExceptHookArgs) -> None:
        if is_ending.is_set() and issubclass(failure.exc_type, rospy.ROSException):
            return
        tell_all(failure)
        if is_ending.is_set():
            return
        thread = failure.thread.name if failure.thread else "unknown"
        reason = f"the thread {thread} has died of {failure.exc_type.__name__}: {failure.exc_value}"
        print(f"[{rospy.get_name()}] error: {reason}", file=sys.stderr, flush=True)
        failures.append(reason)
        _end_within(SHUTDOWN_SECONDS, THREAD_DIED)
        # In a thread of its own: a hook that waits for this one, as rospy's may, would wait for ever.
        threading.Thread(target=rospy.signal_shutdown, args=[reason], daemon=True).start()

    return end


def _end_within(seconds: float, exit_code: int) -> threading.Timer:
    """rospy waits for ever if the master goes away while a topic is being registered."""
    watchdog = threading.Timer(seconds, os._exit, [exit_code])
    watchdog.daemon = True
    watchdog.start()
    return watchdog
