"""What a robot senses: each sensor has frozen settings, one verb, and a generator of its noise."""
