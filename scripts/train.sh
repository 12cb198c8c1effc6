#!/usr/bin/env bash
# Usage: ./scripts/train.sh [options]
#
# Train the learned local planner of src/plugin_examples (docs/how_to/train_a_planner.md) in generated homes, by an
# evolution strategy on CPUs, and print each generation. Performs the set-up if needed, with gymnasium.
# Exit code: 0 success, 2 invalid input, 130 interrupted.
#
#   --generations N  number (default: 60)
#   --pairs N        of opposite perturbations in a generation (default: 8)
#   --episodes N     in which each is evaluated (default: 4)
#   --workers N      processes (default: 2)
#   --seed N         seed (default: 0)
#   --output FILE    file of the weights, written after each generation (default: learned.npz)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command train "$@"
