"""What people do with a robot at their keyboard: they place a ball, send it somewhere, drive it about."""

from run_project.lessons.plan import Lesson
from run_project.ros.people.chasing import chase
from run_project.ros.people.localizing import localize
from run_project.ros.people.mapping import make_map
from run_project.ros.people.person import Person

DEEDS = {Lesson.CHASE: chase, Lesson.LOCALIZE: localize, Lesson.MAP: make_map}

__all__ = ["DEEDS", "Person"]
