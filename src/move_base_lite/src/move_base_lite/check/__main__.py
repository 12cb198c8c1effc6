"""Holds a plugin to its contract: ``python3 -m move_base_lite.check NAME``."""

import argparse
import sys
from typing import Any, List, Optional, Tuple

from move_base_lite.check import KITS, Check, CheckFailed, Kit
from move_base_lite.plugin import Plugin
from planar import PlanarError
from planar.plugins import PluginError


def main(arguments: Optional[List[str]] = None) -> int:
    """Returns 0 if the plugin does all that is asked, 1 if not, 2 if there is no such plugin."""
    parser = argparse.ArgumentParser(
        prog="python3 -m move_base_lite.check",
        description="Try a planner, a recovery behaviour or a costmap layer on tiny maps: does it do what "
        "its contract says?",
    )
    parser.add_argument("name", metavar="NAME", help="my_package.my_module/MyPlanner, or an official name")
    parser.add_argument("--kind", choices=KITS, help="what it is, if it could be several")
    options = parser.parse_args(arguments)
    try:
        kit, plugin = _found(options.name, [options.kind] if options.kind else list(KITS))
    except PluginError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    failed = sum(not _passes(plugin, check) for check in kit.checks)
    print(f"{options.name}: {len(kit.checks) - failed} of {len(kit.checks)} checks passed")
    return 1 if failed else 0


def _found(name: str, kinds: List[str]) -> Tuple[Kit, Plugin[Any]]:
    """The plugin, and the kit of its seam. Raises PluginError with what it lacks."""
    reasons = []
    for kind in kinds:
        try:
            plugin = KITS[kind].registry.find(name, is_package_needed=False)
        except PluginError as error:
            reasons.append(str(error))
            continue
        if plugin is not None:
            return KITS[kind], plugin
    raise PluginError("\n       ".join(dict.fromkeys(reasons)) or f"there is no plugin {name}")


def _passes(plugin: Plugin[Any], check: Check) -> bool:
    asked = (check.__doc__ or "").strip().splitlines()[0]
    try:
        check(plugin)
    except (CheckFailed, PlanarError) as error:
        print(f"FAIL  {asked}\n      {error}")
        return False
    print(f"ok    {asked}")
    return True


if __name__ == "__main__":
    sys.exit(main())
