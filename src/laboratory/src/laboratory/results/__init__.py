"""What runs came to: measured, kept, told."""
