"""What every process does: environment, start, pulse, log, metrics, health, end."""
