"""Action servers, and clients of actions and services with time-outs."""
