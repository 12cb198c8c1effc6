#!/usr/bin/env bash
# Usage: ./scripts/gymnasium.sh ENVIRONMENT [options]
#
# Run episodes of a Gymnasium environment (docs/how_to/train_a_policy.md), such as PointGoal-v0, and print the results.
# Performs the set-up if needed, with gymnasium. Exit code: 0 success, 2 invalid input, 130 interrupted.
#
#   --policy NAME    module/function: gets an observation, gives an action (default: random actions)
#   --arguments YAML of the environment, such as "{scenario: homes}"
#   --seed N         seed (default: 0)
#   --episodes N     number (default: 1)
#   --gif FILE       an animation of them
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command gymnasium "$@"
