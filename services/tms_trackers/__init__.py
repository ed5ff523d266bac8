"""Receives what trackers of people, vehicles and gates tell. No protective device."""
