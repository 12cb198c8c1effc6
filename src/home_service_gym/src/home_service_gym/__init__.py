"""Gymnasium environments of the robot and its worlds, without ROS: docs/how_to/train_a_policy.md.

import gymnasium
env = gymnasium.make("home_service_gym:PointGoal-v0")
"""

import gymnasium

# Environment id, class, maximum duration of an episode [s], control rate [Hz].
_ENVIRONMENTS = (
    ("HomeService-v0", "environments:HomeServiceEnv", 120, 10),
    ("PointGoal-v0", "environments:PointGoalEnv", 60, 10),
    ("BARN-v0", "environments:BarnEnv", 100, 10),
    ("DynaBARN-v0", "environments:DynabarnEnv", 100, 10),
    ("Follow-v0", "environments:FollowEnv", 60, 10),
    ("Explore-v0", "environments:ExploreEnv", 300, 10),
    ("TurtleBot3Stage-v0", "turtlebot3_stage:TurtleBot3StageEnv", 100, 5),
)
NAMES = tuple(name for name, *_ in _ENVIRONMENTS)

for _name, _class, _seconds, _rate in _ENVIRONMENTS:
    if _name not in gymnasium.registry:
        gymnasium.register(_name, f"{__name__}.{_class}", max_episode_steps=_seconds * _rate)
