"""TensegrityRobot, its state, placement, start poses, gait metrics, rendering."""
