"""The task service: it loads behaviour trees and runs them on the machines."""
