"""The case file that `fyke new` writes: a panel to start from, with every key in it."""

from __future__ import annotations

_TEMPLATE = """\
# A case file of fyke. A number is in SI units; a text in quotes may carry a unit:
#   length m mm cm km um in ft fathom    speed m/s cm/s mm/s kn km/h ft/s    time s ms us min h
#   pressure Pa kPa MPa GPa N/mm2        density kg/m3 g/cm3 g/l            force N kN mN kgf
#   angle deg rad, always with its unit  mass kg g t
# The axes: z up with still water at z = 0, x downstream. Lines that start with "# " show what may be added.
schema = 1
title = "Knotted nylon panel, 8 x 8 diamond meshes, on a square frame"

[water]
density = 1000.0                     # kg/m3
kinematic_viscosity = 1.0e-6         # m2/s, for Reynolds numbers
gravity = 9.81                       # m/s2
# depth = 20.0                       # m, to the sea bed; deep water without it

[current]
velocity = [0.5, 0.0, 0.0]           # m/s; or ["1 kn", 0.0, 0.0]; or, instead of it:
# speed = 0.5                        # m/s, and the direction in which the water goes, from +x turning to +y
# direction = "15 deg"
# By depth, m below the surface: a power law from the velocity there to the sea bed (depth in [water]); or, instead of
# velocity, layers that hold down to the next, or a table that is straight between its depths:
# profile = { kind = "power", exponent = 0.143 }
# profile = { kind = "layers", depth = [0, 5], velocity = [[0.5, 0, 0], [0.3, 0, 0]] }
# profile = { kind = "table", depth = [0, 10], speed = [0.5, 0.3], direction = ["0 deg", "20 deg"] }
# file = "current.csv"               # instead of velocity: columns time,u,v,w or time,depth,u,v,w; or netCDF
# at = "3 h"                         # time of the file at which the run begins, its first by default
# ramp = "10 s"                      # smooth start of a dynamic case from rest

# [waves]
# kind = "airy"                      # airy | stokes2 | jonswap | pierson-moskowitz
# height = 1.0                       # m, crest to trough; height, period and phase are of regular waves
# period = "6 s"
# phase = "0 deg"
# direction = "0 deg"                # in which they go, from +x turning to +y
# ramp = "10 s"                      # over which the waves grow from nothing
# stretching = "wheeler"             # wheeler | none; stokes2 has none of it
# For kind = "jonswap" or "pierson-moskowitz":
# significant_height = 1.0           # m
# peak_period = "6 s"
# gamma = 3.3                        # of jonswap; by Tp / sqrt(Hs) without it
# components = 200
# seed = 1                           # the same seed gives the same sea
# spreading = { exponent = 10, directions = 15 }

[twine.main]                         # any number of twines, each with a name
material = "PA"                      # PA, PES, PP, PE, UHMWPE, CuZn or your own: density, modulus where you give none
density = 1140.0                     # kg/m3, of the fibre
diameter = "1.5 mm"                  # or, instead of it or with it, the mass per length:
# rtex = "2000 tex"
# packing = 0.65                     # share of fibre in the cross-section, where rtex makes the diameter
# lead = "1 g/m"                     # of a lead line, beside its fibre
youngs_modulus = "1.0 GPa"           # or, instead of it, one of these laws:
# law = { kind = "linear", youngs_modulus = "1.0 GPa" }
# law = { kind = "power", c1 = "345.37 MPa", c2 = 1.0121 }
# law = { kind = "quadratic", c1 = "1160 N", c2 = "37.3 kN" }
# law = { kind = "table", strain = [0.0, 0.05, 0.1], tension = [0.0, 20.0, 60.0] }   # N
# damping_time = "20 us"             # Kelvin-Voigt retardation time; by default from the loss factor of the material
# breaking_strength = "250 N"          # of one twine, wet and knotted; the largest tension is compared with it

# [material.own]                     # a material of your own, material = "own" in a twine
# density = 1140.0                   # kg/m3
# youngs_modulus = "1.0 GPa"
# loss_factor = 0.02                 # tan delta, from which twine damping comes
# source = "data sheet of the maker"

[netting.main]                       # any number of nettings, each with a name
twine = "main"
mesh = "diamond"                     # diamond | square | hexagonal
bar_length = "30 mm"                 # knot centre to knot centre, unloaded
knot_diameter = "3.5 mm"             # leave out for knotless netting
# long_bar = "45 mm"                 # of hexagons, whose bar_length is that of the slanted bars
# orientation = "T0"                 # of hexagons: long bars along the height (T0) or the width (T90)
# knot_density = 1140.0              # kg/m3, the twine's by default
# segments = 2                       # straight pieces of every bar, so that it can bow; 1 by default
# group = 4                          # one mesh is laid for 4 x 4; 1 by default; also in one [[gear]] of netting alone

# [grouping]                         # instead of group: as fine as so many knots of all netting together allow
# knots = 5000

[[gear]]                             # one for every part
kind = "panel"
# name = "left"                      # shown before the knot's row and column
netting = "main"
meshes = [8, 8]                      # along the width, along the height
size = [0.3055, 0.3055]              # m, width and height of the frame; or, instead of it:
# hanging_ratio = 0.6                # width over stretched width; the height follows from unloaded diamonds
# hanging_ratio = [0.6, 0.7]         # width and height over the stretched ones
centre = [0.0, 0.0, -0.5]            # m
normal = [1.0, 0.0, 0.0]             # the panel's width axis is horizontal
fixed = "edges"                      # edges | top | corners | none (dynamic only)

# Netting round an axis, and what hangs on netting; every part has a name of its own:
# [[gear]]
# kind = "cylinder"                  # cylinder | cone (its tip below) | frustum
# name = "cage"
# netting = "main"
# meshes = [64, 18]                  # around, along the height
# diameter = "0.8 m"                 # through the knots of the rim; of a frustum: [lower, upper]
# height = "0.8 m"
# hanging_ratio = [0.6, 0.8]         # instead of diameter and height, of a cylinder or a cone
# top = [0.0, 0.0, 0.0]              # m, centre of the upper rim
# fixed = "top"                      # top | edges | none (dynamic only)
# bottom = { meshes = 10, depth = "0.1 m" }   # of a cylinder or a frustum; flat without depth
# [[gear]]
# kind = "rope"
# name = "footrope"
# twine = "main"
# along = "cage.bottom"              # NAME.EDGE of netting: top, bottom, left, right
# length = "2.5 m"                   # unloaded, that of the edge by default
# [tube.pipe]                        # of rings and collars
# material = "HDPE"                  # HDPE, steel or your own: density, modulus, yield stress where you give none
# diameter = "315 mm"                # outer
# wall = "17.9 mm"
# contents = "air"                   # air | water
# density = 958.0                    # kg/m3, of the wall
# youngs_modulus = "900 MPa"
# mass_per_length = "18 kg/m"        # with what is fitted to it; that of the wall by default
# yield_stress = "26 MPa"            # which the largest stress is compared with
# [[gear]]
# kind = "collar"                    # floats, and sets the edge free
# name = "collar"
# tube = "pipe"
# tubes = 2                          # side by side
# rigid = false                      # true: it keeps its shape
# along = "cage.top"
# [[gear]]
# kind = "ring"                      # such as a sinker tube
# name = "sinker tube"
# tube = "pipe"
# along = "cage.bottom"
# [[gear]]
# kind = "ring"                      # of its own, its knots "hoop:0", "hoop:1" ...
# name = "hoop"
# tube = "pipe"
# diameter = "25 m"
# centre = [0.0, 0.0, -15.0]
# knots = 48
# [[gear]]
# kind = "sinkers"
# name = "weights"
# along = "cage.bottom"
# count = 16                         # evenly along it, or spacing = "0.5 m"; one at every knot by default
# weight = "5 N"                     # of each one in water, with its density; or, instead, mass and diameter
# density = 7850.0
# drag = 0.47                        # C_D of each one
# [[gear]]
# kind = "floats"
# name = "corks"
# at = ["cage:0-0", "cage:8-0"]      # labels of knots; or along, as for sinkers
# buoyancy = "5 N"                   # lift of each one under water, with its density
# density = 200.0

# Lines free of netting, and the sea bed, which lies at the depth of [water]:
# [bed]
# friction = 0.5
# stiffness = 3e6                    # Pa per metre of sinking in
# damping = 3e5                      # Pa s/m
# [chain.links]                      # steel chain, which lines may name as their twine
# bar_diameter = "13 mm"             # of the steel of its links
# links = "studless"                 # studless | studded
# breaking_strength = "150 kN"
# [[gear]]
# kind = "line"
# name = "warp"
# from = [6.0, 0.0, 0.0]             # a place, m, or a knot: "cage:0-0", "cage.top[0]", "footrope:3"
# to = "left.top[0]"
# twine = "rope"                     # or a [chain.NAME]
# length = "6.5 m"                   # unloaded; or, instead of it:
# pretension = "20 N"                # at its end (to), as it hangs in still water
# segments = 20
# pieces = [{ twine = "rope", length = "6.5 m", segments = 10 }]   # instead of twine and length
# fixed = "both"                     # both | from | to | none: which of its ends that are places are held
# [[gear]]
# kind = "moorings"                  # lines as above, from anchors on the sea bed, evenly around a rim or ring
# around = "cage.top"
# count = 4
# radius = "5 m"                     # of the circle of anchors
# bearing = "45 deg"                 # of the first one, from +x turning to +y
# twine = "rope"
# length = "25 m"

# Netting cut to shape, cages with four walls, and seams:
# [[gear]]
# kind = "trapezoid"                 # trapezoid | triangle (point = "down" or "up" instead of cut and lower)
# name = "wing"
# netting = "main"
# meshes = [12, 6]                   # along the upper edge, along the height
# cut = "1N2B"                       # cutting rate of both sides, or ["AN", "1N2B"], left and right
# lower = 6                          # meshes along the lower edge; one of the two is enough
# hanging_ratio = 0.6                # or size, width of the wide end and height
# centre = [0.0, 0.0, -0.5]
# [[gear]]
# kind = "box"
# name = "box"
# netting = "main"
# meshes = [8, 8, 6]                 # along x, along y, along the depth
# size = [0.3, 0.3, 0.2]             # or hanging_ratio
# bottom = true                      # false leaves it open
# top = [0.0, 0.0, -0.2]             # m, middle of the upper rim
# fixed = "top"
# [[gear]]
# kind = "trapezoid"
# name = "square"
# netting = "main"
# meshes = [12, 4]
# lower = 12
# hanging_ratio = 0.6
# centre = [0.0, 0.0, -0.26]
# fixed = "top"
# [[gear]]
# kind = "seam"
# name = "joining"
# join = ["square.bottom", "wing.top"]
# take_up = 1.0                      # meshes of the first edge on those of the second, 1.5 or "3:2"; 1 without it

# Held knots that move, in a dynamic case; several [[motion]] of the same knots add up:
# [[motion]]
# of = ["cage.top"]                  # NAME.EDGE, labels of knots, names of gear; all held knots by default
# velocity = [-0.5, 0.0, 0.0]        # m/s, of a tow
# amplitude = [0.0, 0.0, 0.5]        # m, of a swing, amplitude x sin(2 pi t / period + phase)
# period = "6 s"
# phase = "0 deg"
# rotation = { axis = [0, 1, 0], point = [0, 0, 0], amplitude = "5 deg", period = "6 s" }   # or rate = "10 deg/s"
# file = "motion.csv"                # columns time,dx,dy,dz (s, m), time,roll,pitch,yaw (deg) or all of them
# ramp = "2 s"                       # smooth start

[drag]
bars = { law = "constant", normal = 1.2, tangential = 0.1 }    # on diameter x current length
knots = { law = "constant", drag = 1.0 }                       # on pi d^2 / 4
# Or published laws, alone by their word or with their parameters; fyke laws lists them, their ranges and sources.
# bars = "choo-casarella"            # or takagi, bessonneau-marichal, wan
# bars = { law = "ns-cheng", tangential = 0.05 }    # or kristiansen-faltinsen, white, sucker-brauer: none along a bar
# bars = { law = "cifuentes-kim", solidity = 0.2 }  # as hung, where you leave it out
# bars = { law = "hoerner", across = 1.1, friction = 0.02 }
# bars = { law = "table", file = "drag.csv" }       # columns reynolds,normal,tangential; angle-table: by angle too
# knots = { law = "schiller-naumann", shape = 1.2 } # or clift-gauvin, clift-grace-weber
# kind = "screens"                   # drag of whole meshes, not of bars and knots, by one of the laws of panels:
# screens = { law = "kristiansen-faltinsen", series = "simple" }    # or aarsnes, loland, balash, fridman, bi, lee

[added_mass]                         # over the mass of the displaced water
bars = 1.0                           # C_a, across the bar only
knots = 0.5
# bars = { law = "constant", inertia = 2.0 }        # where you know the inertia coefficient 1 + C_a
# bars = "lee"                       # sine of the angle between bar and flow; or potential-flow
# bars = { law = "table", angle = ["0 deg", "90 deg"], coefficient = [0.1, 1.0] }    # or a file by angle

[shelter]                            # what netting leaves of the current; off unless asked for
# wake = "loland"                    # behind it: off | loland | momentum | cheng, or a factor from 0 to 1
# twines = "cheng"                   # between the twines of a panel that leans: off | cheng

[solve]
kind = "static"                      # static | dynamic
# tolerance = 1e-8                   # N, largest unbalanced force on a free knot
# For kind = "dynamic":
# duration = 2.0                     # s
# start = "equilibrium"              # begin at rest in the water of time 0; "built" as the file has the net
# stepper = "auto"                   # auto | implicit | newmark | verner | symplectic
# rtol = 1e-2
# atol = 1e-6
# max_step = "1 ms"
# settle_force = 1e-6                # N, end early once every free knot is balanced to this
# settle_energy = 1e-9               # J, end early once the kinetic energy is below this

[output]
# every = 0.02                       # s between outputs of a dynamic run, duration / 100 by default
# periods = 6                        # the slowest natural periods of a static case
# probes = [[0.0, 0.0, 0.0]]         # m, where a run in waves writes the motion of the water

# [[load_case]]                      # the same gear in other water: one table, folder and row of loads.csv for each
# name = "50 years"
# current = { speed = 0.9, direction = "0 deg" }     # with the keys of [current], in its place
# waves = { kind = "jonswap", significant_height = 2.5, peak_period = "7 s" }        # in place of [waves]
# load_factor = 1.3                  # of the utilisation of breaking strengths, as material_factor is
# material_factor = 1.5
# By chosen_load_case at the top of the file, the name of one, that one is run alone.

# [compare]                          # measured positions to lay over the result
# positions = "measured.csv"         # beside this file; columns knot,x,y,z (m), knot as "row-column"
"""


def template() -> str:
    """Return a commented case file that runs as it is."""
    return _TEMPLATE
