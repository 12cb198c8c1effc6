"""Settings: YAML files and parameters made into checked values."""
