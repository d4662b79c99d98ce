"""What may have acted on a recording and is no physics of the actuator: tried where no explanation accounts for all."""
