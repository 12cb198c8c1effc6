"""What results prove, and what they do not."""
