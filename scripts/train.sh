#!/usr/bin/env bash
# Usage: ./scripts/train.sh [options]
#
# Trains the learned local planner of src/plugin_examples (docs/how_to/write_a_plugin.md) in generated homes, by an evolution
# strategy on CPUs alone, and tells of each generation. Sets everything up first if need be, with gymnasium.
# Exit code: 0 success, 2 bad input, 130 interrupted.
#
#   --generations N  how many (default: 60)
#   --pairs N        of opposite changes that a generation tries (default: 8)
#   --episodes N     that each is tried on (default: 4)
#   --workers N      processes (default: 2)
#   --seed N         of all chance (default: 0)
#   --output FILE    the weights are kept here after each generation (default: learned.npz)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command train "$@"
