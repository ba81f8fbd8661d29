#!/bin/sh
# seed.sh: make the seeds of the corpus anew, with the tools in PATH; what else lies there stays.
# Seeds are small, so that a fuzzer gets through them fast: few samples, few scales.
set -eu
cd "$(dirname "$0")/corpus"
mkdir -p scene text delimited au coefficients hdf5 sweep features events
short='--set settle=0 --set rate=1000'

for name in coulomb state-variable compliant-light; do
    cp ../../../data/scenes/$name.scene scene/$name
done
printf '%s\n' model=coulomb mass=1 stiffness=1e3 friction=0 base_amplitude=1e-3 base_frequency=2.5 \
    x0=-1 > scene/least
{ cat scene/least; printf '\0model = compliant\n'; } > scene/setting

# shellcheck disable=SC2086  # options are a list
{
ss-sim $short --set duration=0.01 compliant-light > text/simulated
ss-sim $short --set duration=0.01 --columns x,mode coulomb > text/no-time
ss-signal step --duration 0.005 > text/step
printf '%s\n' '# stickslip signal 1' '# k: v' '# rate: 1e3' '# start: -0.5' \
    '# columns: x/(m (N)) x x/m' '' '-1e-300 2e300 0x' > text/odd
ss-sim $short --set duration=0.01 --format au compliant-light > au/simulated
ss-signal noise --duration 0.004 --format au > au/noise
ss-sim $short --set duration=0.01 --columns t,x coulomb | ss-cat -o hdf5/signal.h5
ss-sim $short --set duration=0.03 --columns t,a coulomb |
    ss-morlet --voices 1 --center 2 --force -o hdf5/stepped.h5
ss-sim $short --set duration=0.03 --columns t,a coulomb |
    ss-morlet --voices 1 --center 2 --force --dense -o hdf5/dense.h5
ss-sim $short --set duration=0.03 coulomb > run
}
ss-morlet --voices 2 --center 2 --force run > coefficients/stepped
ss-morlet --voices 1 --center 2 --force --dense run > coefficients/dense
ss-morlet --dyadic --center 3 --force --norm l1 run > coefficients/dyadic
ss-morlet --voices 1 --center 2 --force --format au run > coefficients/binary
ss-morlet --voices 1 --center 2 --octaves -7:-6 --force --stream --format au run \
    > coefficients/binary-stream
ss-morlet --voices 1 --center 2 --octaves -7:-6 --force --stream run > coefficients/stream
rm run

# AU of 8 to 32 bits and float, two channels: 4 rows of made-up bytes.
for encoding in 2 3 4 5 6; do
    {
        printf '.snd\0\0\0\030\377\377\377\377\0\0\0\00%s' "$encoding"
        printf '\0\0\003\350\0\0\0\002abcdefgh>*b?>|#,12345678'
    } > au/encoding$encoding
done

# What a header says of a length need not be so.
for length in '000 000 000 000' '000 000 000 002' '177 377 377 377'; do
    # shellcheck disable=SC2086  # four bytes
    printf '.snd\0\0\0\030%b\0\0\0\003\0\0\003\350\0\0\0\001abcdefgh' "$(printf '\\0%s' $length)" > "au/length${length##* }"
done
printf 'RIFF\044\0\0\0WAVEfmt \020\0\0\0\001\0\001\0\100\037\0\0\0\0\0\0\002\0\020\0data\0\0\0\0\0\0\001\002' > au/wav-length0
printf 'RIFF\0\0\0\0WAVEfmt \020\0\0\0\001\0\002\0\100\037\0\0\0\0\0\0\010\0\030\0data\010\0\0\0abcdefgh' > au/wav-wide

printf 'label,t_s,x\nok,0,1\nlate,0.5,2\nok,1,3\n' > delimited/words
printf '%s\n' 'when;x' '2024-02-28T23:59:59,5+01:00;1' '2024-02-29T00:00:00,0+01:00;2' > delimited/dates
printf '%s\n' Date,Time,x 2024/02/28,23:59:59.5,1 2024/02/29,00:00:00.0,2 > delimited/times
printf '%s\n' 'Step 1' t,Fx sec,N 0,1 0.01,2 '' 'Step 2' t,Fz,Fx sec,N,N 0,1,2 0.01,2,3 > delimited/tables
printf 'Channel name\ta\tb\nUnit\tN\tg\nInterval\t0.001\t0.001\n1.5\t2.5\n1.0D-2\t2.25\n' > delimited/interval
for layout in No One Multi; do
    case $layout in No) row='\t1\t2' ;; One) row='0\t1\t2' ;; *) row='0\t1\t0\t2' ;; esac
    {
        printf 'LabVIEW Measurement\t\nX_Columns\t%s\n***End_of_Header***\t\n' $layout
        for _ in 1 2; do
            printf 'Channels\t2\nY_Unit_Label\tN\tm\nX_Dimension\tTime\tTime\nX0\t0\t0\nDelta_X\t0,5\t0,5\n'
            printf '***End_of_Header***\nX_Value\ta\tb\tComment\n%b\tnow\n\n' "$row"
        done
    } > delimited/labview-$layout
done
npy() { printf '\223NUMPY\001\000%b\000%s\n%b' "$(printf '\\%o' $((${#1} + 1)))" "$1" "$2"; }
npy "{'descr': '<i2', 'fortran_order': False, 'shape': (3, 2), }" '\001\000\002\000\003\000\004\000\005\000\006\000' \
    > delimited/npy
npy "{'descr': '>f4', 'fortran_order': True, 'shape': (2, 2), }" '\077\200\000\000\100\000\000\000\077\200\000\000\077\200\000\000' \
    > delimited/npy-fortran
npy "{'descr': [('t', '|u1'), ('', '|V2'), ('x', '<u2')], 'fortran_order': False, 'shape': (2,), }" \
    '\000zz\001\000\001zz\002\000' > delimited/npy-fields
printf 't,x\n0,1\n1e-310,2\n2e-310,3\n' > delimited/subnormal-step
printf '%s\n' 'Time (ms);Force [N];x/mm' '0,0;1,5;-2' '0,5;1,25;3' '1,0;0;4' '1,5;1e-3;5' \
    > delimited/semicolon
printf '%s\n' '"Date","Nov, 21"' Rate,1000 '"t","a ""b"""' s,m/s^2 0,1 0.001,2 0.002,3 \
    > delimited/comma
printf '# x y\n 0 1\n\n 0.25  2 \r\n0.5 4\n0.75 8' > delimited/blanks
printf '\357\273\277X_Value\tVoltage\tComment\n0\t1\t\n0.1\t2\t\n0.2\t3\t\n' > delimited/labview
printf '1\n2\n-3e5\n' > delimited/column
printf 't\tx\n0\tnan\n1\t\n' > delimited/refused

# Grids of a count and of a number, one with points missing, and two shards with a header each.
ss-sweep -m stops,amplitude,period --vary base_frequency=2:8:3 --vary friction=0.1:1.5:4 coulomb > sweep/grid
ss-sweep -m amplitude,stops --vary mass=-1:1:3 --vary stiffness=1000:4000:3:log coulomb > sweep/missing
for shard in 1 2; do
    ss-sweep --shard $shard/2 -m stops,amplitude --vary friction=0.1:1.5:3 --vary contact_stiffness=1e5:1e6:3:log \
        compliant-light
done > sweep/shards

# Lists that are drawn over contours: as the tools write them, and with less in them.
ss-sim --events --set settle=0 --set duration=0.4 coulomb > events/simulated
printf '# stickslip events 1\n0.5\n-1e-3, slip\n\n 7 x\r\n' > events/others
ss-sim -s duration=1 compliant-light | ss-features -c a | cut -c 1-90 > features/found
{
    echo '# stickslip features 1'
    printf '0.1\t0.2\t3\t0.15\t45.3\n0.3\t0.4\t1\t-\t-\n-\t-\t0\t0.5\t20\n'
    printf '# spike: %s\n' '0.125 kink -3' '7 jump' '0.2 bend -9 40'
} > features/others

