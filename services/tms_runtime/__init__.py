"""What every process does: start, pulse, log, metrics, health, end."""
