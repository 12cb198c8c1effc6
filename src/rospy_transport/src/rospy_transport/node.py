"""ROS time, remapped names, and the end of this node, as far as rospy does not publish them."""

import importlib
from contextlib import contextmanager
from typing import Any, Callable, Iterator, Optional

import rospy
import rospy.core
import rospy.names
import rospy.rostime
from rospy.impl.paramserver import get_param_server_cache
from rospy.impl.registration import RegManager, get_registration_listeners

# Interval at which a shutdown is detected.
LONGEST_WAIT_SECONDS = 0.2


def is_initialized() -> bool:
    """Return whether this process is a node; needed because ``rospy.init_node`` fails for another name."""
    return bool(rospy.core.is_initialized())


def is_shutting_down() -> bool:
    """Return whether the shutdown has begun; ``rospy.is_shutdown`` is true only after the node's hooks."""
    return bool(rospy.core.is_shutdown_requested())


def on_topics_closed(hook: Callable[[], None]) -> None:
    """Call a function after rospy has closed all topics; ``rospy.on_shutdown`` calls its hooks before.

    Args:
        hook: The function; register it after ``rospy.init_node``.
    """
    rospy.core.add_preshutdown_hook(lambda _reason: hook())


def on_unregistered(hook: Callable[[], None]) -> None:
    """Call a function after the node was unregistered at the master; ``rospy.on_shutdown`` does so before.

    Args:
        hook: The function; register it after ``rospy.init_node``.
    """
    rospy.core.add_shutdown_hook(lambda _reason: hook())


def end_registration_at_shutdown() -> None:
    """Have the thread that registers topics end with the node; call it after ``rospy.init_node``.

    rospy waits for it at shutdown, but it looks for the shutdown each half second only.
    """
    managers = [each for each in get_registration_listeners().listeners if isinstance(each, RegManager)]

    def wake(_reason: str) -> None:
        for manager in managers:
            with manager.cond:
                manager.cond.notify_all()

    rospy.core.add_shutdown_hook(wake)


def cache_parameter(name: str, value: Any) -> None:
    """Set the value that rospy uses for a parameter, so that it does not subscribe to it.

    rospy subscribes to a parameter with each log message and never unsubscribes.
    """
    get_param_server_cache().set(name, value)


def reload_remappings() -> None:
    """Read the remappings in ``sys.argv`` again, and the name of the node; rospy read them at its import."""
    importlib.reload(rospy.names)


def discard_remapping(name: str) -> None:
    """Remap a name no more; rospy would remap again a name that is the result of a remapping.

    Args:
        name: Resolved name.
    """
    rospy.names.get_resolved_mappings().pop(name, None)


def is_wall_clock() -> bool:
    """Return whether rospy uses wall time, which it decides once, at ``rospy.init_node``."""
    return bool(rospy.rostime.is_wallclock())


def set_time(stamp: rospy.Time) -> None:
    """Set simulated time to that of a logical instant; rospy takes it from /clock, which may arrive later."""
    rospy.rostime._set_rostime(stamp)


def sleep_until(due: rospy.Time, since: Optional[rospy.Time] = None) -> rospy.Time:
    """Wait until ROS time reaches a time.

    Unlike ``rospy.sleep`` it handles every clock message and waits for a point in time instead of a duration:
    while the simulation waits for this node, the clock stands still, and a wait that is one step too long
    would never end.

    Args:
        due: Time to wait for.
        since: Earlier reading of the clock, by default now; an earlier time than this is a jump back.

    Returns:
        ROS time at the end.

    Raises:
        rospy.ROSTimeMovedBackwardsException: If time jumps back.
        rospy.ROSInterruptException: On shutdown.
    """
    if is_wall_clock():
        rospy.sleep(due - rospy.Time.now())
        return rospy.Time.now()
    changed, start = rospy.rostime.get_rostime_cond(), rospy.Time.now() if since is None else since
    with changed:
        while True:
            now = rospy.Time.now()
            if now < start:
                raise rospy.ROSTimeMovedBackwardsException((start - now).to_sec())
            if now >= due and now != rospy.Time(0):
                return now
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("shutdown while waiting for the clock")
            changed.wait(LONGEST_WAIT_SECONDS)


@contextmanager
def unregistered_node() -> Iterator[None]:
    """Let this process publish and read the time as a node that no master knows, for tests."""
    rospy.core.set_initialized(True)
    rospy.rostime.set_rostime_initialized(True)
    try:
        yield
    finally:
        rospy.rostime.switch_to_wallclock()
        rospy.rostime.set_rostime_initialized(False)
        rospy.core.set_initialized(False)
