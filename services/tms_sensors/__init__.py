"""Hears what the site file and sensing.yaml name: trackers of people, hardware of machines. No protective device."""
