"""Parameters of recovery behaviours."""

from dataclasses import replace
from typing import Any, Dict, List, Mapping, Tuple

from move_base_lite.config import MoveBaseSettings
from move_base_lite.costmap import CostmapSettings, footprint_from
from move_base_lite.parameters.costmaps import layers_of, with_plugins
from move_base_lite.parameters.reader import Reader, below, names_of, renamed
from move_base_lite.recovery import RecoverySettings, RotateSettings, SlowSettings, recovery_from

_ROTATE_NAMES = {
    "acc_lim_th": "acc_lim_theta",
    "max_rotational_vel": "max_vel_theta",
    "min_in_place_rotational_vel": "min_in_place_vel_theta",
}
# All layers of obstacles are cleared, and costmaps are brought up to date every period.
_CLEARING_IGNORED = {"layer_names", "force_updating"}


def recovery_settings(
    reader: Reader, parameters, move_base: MoveBaseSettings, local: CostmapSettings
) -> Tuple[RecoverySettings, ...]:
    listed = parameters.get("recovery_behaviors")
    if listed is None:
        listed = _default_recoveries(move_base.clearing_rotation_allowed)
    names = [item["name"] for item in listed if isinstance(item, dict) and "name" in item and "type" in item]
    if len(names) != len(listed) or len(set(names)) != len(names):
        reader.warnings.append(
            f"{reader.where}recovery_behaviors must be a list of {{name, type}} with different names, "
            "the default ones take their place"
        )
        listed = _default_recoveries(move_base.clearing_rotation_allowed)
    footprint = footprint_from(local.footprint, local.robot_radius, local.footprint_padding)
    distances = {
        "conservative_reset": move_base.conservative_reset_dist,
        "aggressive_reset": 4.0 * footprint.circumscribed_radius,
    }
    recoveries = []
    for item in listed:
        name, kind = item["name"], str(item["type"])
        own = dict(below(parameters, name))
        if name in distances and kind.endswith("ClearCostmapRecovery"):
            own.setdefault("reset_distance", distances[name])
        recoveries.append(_recovery(reader, parameters, name, kind, own))
    return tuple(recoveries)


def _recovery(reader: Reader, parameters, name: str, kind: str, own: Mapping[str, Any]) -> RecoverySettings:
    rotating = renamed(below(parameters, "TrajectoryPlannerROS"), _ROTATE_NAMES)
    rotate = {key: value for key, value in rotating.items() if key in names_of(RotateSettings)}
    where = f"{name}/"
    recovery = RecoverySettings(name, kind)
    if kind.endswith("ClearCostmapRecovery"):
        values = {"name": name, "type": kind, **own}
        recovery = reader.read(RecoverySettings, values, where, _CLEARING_IGNORED)
        _check_layers(reader, parameters, name, own.get("layer_names"))
    elif kind.endswith("RotateRecovery"):
        reader.report_unknown(set(own) - {"sim_granularity", "frequency"}, where, ["sim_granularity"])
        recovery = replace(recovery, rotate=reader.read(RotateSettings, rotate, "TrajectoryPlannerROS/"))
    elif kind.endswith("MoveSlowAndClear"):
        ignored = {"max_trans_param_name", "max_rot_param_name", "planner_namespace"}
        recovery = replace(recovery, slow=reader.read(SlowSettings, own, where, ignored))
    recovery_from(recovery)
    return recovery


def _check_layers(reader: Reader, parameters, name: str, named: Any) -> None:
    """All obstacles are cleared, whatever the name of their layer; one that is not there is a slip."""
    if named is None:
        return
    there = {
        layer
        for costmap in ("global_costmap", "local_costmap")
        for layer in layers_of(Reader(reader.where), with_plugins(below(parameters, costmap)), costmap)
    }
    for layer in named if isinstance(named, list) else [named]:
        if layer not in there:
            reader.warnings.append(
                f"{reader.where}{name}/layer_names: no costmap has a layer {layer} "
                f"(but {', '.join(sorted(there))}); the obstacles of all layers are cleared"
            )


def _default_recoveries(rotation_allowed: bool) -> List[Dict[str, str]]:
    clear, rotate = "clear_costmap_recovery/ClearCostmapRecovery", "rotate_recovery/RotateRecovery"
    order = [("conservative_reset", clear), ("rotate_recovery", rotate), ("aggressive_reset", clear)]
    order.append(("rotate_recovery_again", rotate))
    return [{"name": name, "type": kind} for name, kind in order if rotation_allowed or kind != rotate]
