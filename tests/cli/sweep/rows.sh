# One row a grid point: the last key varied varies fastest, and a point that fails says why.
rows() { awk -F '\t' -v OFS='\t' '!/^#/ { for (i = 2; i < NF; i++) if ($i + 0) $i = sprintf("%.6g", $i) } 1'; }
ss-sweep -m stops,period,amplitude,energy --vary friction=0.6:1.4:3 --vary mass=1:4:2:log coulomb | rows
ss-sweep -m period,cycles,x_max --vary mass=-1:2.42:2 coulomb | grep -v '^#' | rows
ss-sweep -m transition,microslips --vary contact_damping=25:3000:2 compliant-light | grep -v '^#' | rows
ss-sweep -m period,cycles,v_max --max-cycles 7 --vary friction=0.1:0.1:1 coulomb | grep -v '^#' | rows
ss-sweep -m period,cycles --settle-cycles 46 --vary x0=0:1e-3:2 coulomb | grep -v '^#'
ss-sweep -m period,amplitude --vary alpha=1000:3000:2 state-variable | grep -v '^#' | rows
ss-sweep --vary base_frequency=0:2.5:2 -m stops --shoot coulomb | grep -v '^#'
ss-sweep --set base_frequency=0 --set static_friction=1.4 -m cycle_time,stick,period --vary surface_velocity=0:1e-2:3 \
    coulomb | grep -v '^#' | rows
# nothing varied: one row
ss-sweep -m stops,period coulomb | grep -v '^#'
# a key of the model that is set may be varied, though the scene's own model has no such key
falling='-m x_max -s model=stribeck -s static_friction=1.35'
# shellcheck disable=SC2086  # several words
{ ss-sweep $falling --vary stribeck_velocity=1e-3:1e-2:2 coulomb | cut -f 3 | tail -n 2
  ss-sweep $falling -s stribeck_velocity=1e-2 --vary friction=1.28:1.28:1 coulomb | cut -f 3 | tail -n 1; } | uniq -c |
    awk '{ print $1 }'
