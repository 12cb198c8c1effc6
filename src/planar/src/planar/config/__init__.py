"""Settings: frozen dataclasses read from YAML files and parameters, with checks and documentation."""
