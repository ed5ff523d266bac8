"""Machines on tracks between areas, in virtual time, with localisation that fails and ground that slips."""
