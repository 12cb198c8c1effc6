"""Start, failure and shutdown of a node."""

import gc
import logging
import os
import queue
import sys
import threading
from typing import Any, Callable, List

import rospy
from rosgraph import get_master_uri

from planar import PlanarError
from planar_ros.node.entry import use_one_blas_thread
from rospy_transport.node import cache_parameter, end_registration_at_shutdown, on_unregistered
from rospy_transport.replacements import install
from supervision.interruption import on_signals
from supervision.streams import ignore_write_errors

# Time limit for an orderly shutdown.
SHUTDOWN_SECONDS = 5.0
# The exit code of a node one of whose threads has died: EX_SOFTWARE of sysexits.h.
THREAD_DIED = 70
# rospy's option to omit the topics of the node from log messages.
LOG_WITHOUT_TOPICS = "/rosout_disable_topics_generation"
# Exceptions of rospy for publishing during shutdown.
CLOSED = ("publish() to a closed topic", "topic was closed during publish()")


def run(node_name: str, start: Callable[[], object]) -> None:
    """Initialize a node, call ``start`` and wait until shutdown.

    A PlanarError raised by ``start`` is a user error: one line on stderr, exit code 2.

    Args:
        node_name: Name of the node.
        start: Creates the objects of the node; its result is kept alive.
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
    threading.excepthook = _shutdown_hook(is_ending, failures)
    logging.getLogger("rosout").addFilter(
        lambda record: not (is_ending.is_set() and _is_about_shutdown(record))
    )
    on_unregistered(is_over.set)
    try:
        node = start()
        is_over.wait()
        del node
    except PlanarError as error:
        fail(str(error))
    except Exception:
        if not is_ending.is_set():  # otherwise its topics were closed during the start
            raise
        is_over.wait()
    finally:
        # Skip the garbage collection at exit, which takes a third of a second with numba.
        gc.freeze()
    if failures:
        sys.exit(THREAD_DIED)


def init_node(name: str, **options: Any) -> None:
    """Initialize this process as a node that misses no publisher and is unregistered completely when it ends.

    rospy would subscribe to a parameter with each log message and never unsubscribe: the master would then
    treat the next node of this name as a duplicate and shut down whichever node uses the port of the first
    one.

    Args:
        name: Name of the node.
        options: Further arguments of ``rospy.init_node``; signals are left to the caller.
    """
    install()
    rospy.init_node(name, **{"disable_signals": True, **options})
    end_registration_at_shutdown()
    cache_parameter(LOG_WITHOUT_TOPICS, rospy.get_param(LOG_WITHOUT_TOPICS, False))


def shut_down_on_signals(goes_on: bool = False) -> None:
    """Shut the node down in a thread when a signal arrives; call it before ``init_node``.

    rospy would do it in the signal handler, on top of the main thread, and deadlock on a lock that the main
    thread holds, e.g. while it publishes.

    Args:
        goes_on: Whether the process continues after the node has ended, without a time limit.
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
    """Print the reason in one line on stderr and end the node."""
    print(f"[{rospy.get_name()}] error: {text}", file=sys.stderr, flush=True)
    rospy.signal_shutdown(text)
    sys.exit(exit_code)


def _is_about_shutdown(record: logging.LogRecord) -> bool:
    """Return whether a log record is about a topic that rospy closed before it reported the shutdown."""
    return any(words in record.getMessage() for words in CLOSED)


def _shutdown_hook(
    is_ending: threading.Event, failures: List[str]
) -> Callable[[threading.ExceptHookArgs], None]:
    """Make a ``threading.excepthook`` that shuts the node down when a thread dies.

    A partial node would be worse than none, because nothing would restart it. Exceptions from topics that are
    closed during shutdown are ignored.

    Args:
        is_ending: Set during shutdown.
        failures: Receives the reason.
    """
    report = threading.excepthook

    def end(failure: threading.ExceptHookArgs) -> None:
        if is_ending.is_set() and issubclass(failure.exc_type, rospy.ROSException):
            return
        report(failure)
        if is_ending.is_set():
            return
        thread = failure.thread.name if failure.thread else "unknown"
        reason = f"thread {thread} died of {failure.exc_type.__name__}: {failure.exc_value}"
        print(f"[{rospy.get_name()}] error: {reason}", file=sys.stderr, flush=True)
        failures.append(reason)
        _end_within(SHUTDOWN_SECONDS, THREAD_DIED)
        # In another thread: a shutdown hook that joins this one would deadlock.
        threading.Thread(target=rospy.signal_shutdown, args=[reason], daemon=True).start()

    return end


def _end_within(seconds: float, exit_code: int) -> threading.Timer:
    """Exit after a time limit, since rospy blocks for ever if the master disappears during a registration."""
    watchdog = threading.Timer(seconds, os._exit, [exit_code])
    watchdog.daemon = True
    watchdog.start()
    return watchdog
