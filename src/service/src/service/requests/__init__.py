"""Validation, acceptance and repetition of requests."""
