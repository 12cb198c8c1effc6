"""Decides when a project's run is over: nothing more will come of it."""

from typing import NamedTuple

from run_project.judging.run_record import ProjectRunRecord

# Wall time without processes after which they count as gone [s]: a list is not made in one moment.
GONE_SECONDS = 1.0


class Quiet(NamedTuple):
    """Time without goals, markers and windows: wall time and simulated time [s]."""

    wall: float
    simulated: float

    def exceeds(self, limit: "Quiet") -> bool:
        return self.wall > limit.wall and self.simulated >= limit.simulated


# No node is left; the last messages may be under way.
NO_NODES = Quiet(3.0, 0.0)
# No node of a project that has sent no goal is left; its windows may take long to open others.
NOTHING_DONE = Quiet(25.0, 0.0)
# A goal may come; or, with all goals ended, another one; or, without a node that could send one, a marker.
BEFORE_FIRST_GOAL, BETWEEN_GOALS, AFTER_GOALS = Quiet(90.0, 60.0), Quiet(25.0, 30.0), Quiet(8.0, 10.0)
# Enough if the object is delivered, and no node can send a goal or is known to sleep.
DELIVERED = Quiet(0.5, 2.0)
# Wall time that is enough if no thread of the nodes sleeps by it [s]: simulated time waits for nodes.
ENOUGH_WALL_SECONDS = 1.5


def is_over(
    record: ProjectRunRecord,
    quiet: Quiet,
    *,
    script_is_over: bool,
    has_processes: bool,
    has_nodes: bool,
    has_goal_clients: bool,
    is_one_sleeping: bool,
) -> bool:
    """Return whether a run is over.

    Args:
        record: What the project has done.
        quiet: Time since the last event.
        script_is_over: Whether the script has ended.
        has_processes: Whether a process of the run is left.
        has_nodes: Whether a process of the project is left.
        has_goal_clients: Whether a node that can send goals is left.
        is_one_sleeping: Whether a thread of the project's nodes sleeps by wall time.
    """
    if (script_is_over and not has_processes) or record.goals_of_two_rounds:
        return True
    if script_is_over and not has_nodes:
        return quiet.exceeds(NO_NODES if record.goals or record.markers else NOTHING_DONE)
    if not record.goals:
        return quiet.exceeds(BEFORE_FIRST_GOAL)
    may_be_last = not has_goal_clients and not record.is_object_picked_up
    limit = AFTER_GOALS if may_be_last else BETWEEN_GOALS
    if not is_one_sleeping:
        limit = limit._replace(wall=ENOUGH_WALL_SECONDS)
        if may_be_last and record.is_object_delivered:
            limit = DELIVERED
    return record.all_goals_ended and quiet.exceeds(limit)
