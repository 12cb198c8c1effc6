#!/usr/bin/env bash
# Usage: ./scripts/gymnasium.sh ENVIRONMENT [options]
#
# Plays episodes of a Gymnasium environment (docs/how_to/train_a_policy.md), like PointGoal-v0, and says how they went.
# Sets everything up first if need be, with gymnasium. Exit code: 0 success, 2 bad input, 130 interrupted.
#
#   --policy NAME    module/function: gets an observation, gives an action (default: actions by chance)
#   --arguments YAML of the environment, like "{scenario: homes}"
#   --seed N         of all chance (default: 0)
#   --episodes N     how many (default: 1)
#   --gif FILE       an animation of them
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command gymnasium "$@"
