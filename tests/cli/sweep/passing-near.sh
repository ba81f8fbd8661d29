# A motion that comes near a stable one, even for some cycles as its derivative says, and then goes on to another one:
# as it is after 3000 cycles, which are simulated.
for point in '9 2.3' '2.7058823529411766 3.55' '7.88235294117647 2.55'; do
    for how in --max-cycles=400 --settle-cycles=3000; do
        ss-sweep -q -m period,amplitude -t 1e-8 -s base_velocity=.01 -s base_frequency="${point% *}" \
            -s static_friction="${point#* }" $how compliant-light | awk '!/^#/ { printf "%s %.5g\n", $2, $3 }'
    done | uniq -c | awk '{ print $1, $2 }'
done
