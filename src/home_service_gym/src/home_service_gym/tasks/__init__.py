"""What is to be done in the environments, one a file."""
