"""Velocity commands: the cmd_vel multiplexer, the smoother, and wheel drives."""
