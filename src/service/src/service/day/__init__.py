"""A day of service without physics: generated requests, a robot without physics."""
