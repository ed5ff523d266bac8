"""Robot planning: turns a goal for an excavator's arm into a joint trajectory inside its limits."""
