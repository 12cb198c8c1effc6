"""Scripted users: the interaction that course projects need, with checks of the result."""

from run_project.course.launch_plan import CourseProject
from run_project.ros.scripted_user.ball_chasing import check_ball_chasing
from run_project.ros.scripted_user.localization import check_localization
from run_project.ros.scripted_user.mapping import check_mapping
from run_project.ros.scripted_user.user import ScriptedUser

PROCEDURES = {
    CourseProject.CHASE: check_ball_chasing,
    CourseProject.LOCALIZE: check_localization,
    CourseProject.MAP: check_mapping,
}

__all__ = ["PROCEDURES", "ScriptedUser"]
