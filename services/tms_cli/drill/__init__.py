"""The drill: kills processes while a simulated machine moves, and measures what happens."""
