"""The viewer: a robot, a replay, a study or a hinge in a browser, served by viser on loopback.

`choice.py` is what is asked for, `session.py` a robot that does it, in a process of its own; `frame.py` is what comes
out of one, thirty times a second. `page.py` serves a page, `robot_scene.py` draws frames into it, `plots.py` beside it,
`controls.py` is its panel, and `live.py` lets all of them run. `player.py` plays recordings, those of a design study
that `study.py` makes among them; `hinge_view.py` and `hinge_scene.py` bend a hinge.
"""
