"""What a robot is: parameter groups, RobotDesign, its file, its URDF."""
