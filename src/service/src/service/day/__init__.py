"""A day of service without physics: generated requests, a robot that takes its time, charts of what was kept."""
