"""`make soak MINUTES=n`: two trucks and an excavator work for hours, while processes are killed."""
