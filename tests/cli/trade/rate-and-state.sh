# ss-trade --models of rate and state: Stribeck and Coulomb friction drop as far, about, and begin again as soon; but
# slips begin at once there, where rate and state nucleate.
ss-trade --models -o rows.tsv rate-and-state-mild
awk -F '\t' '!/^#/ { print $1, ($2 < 0.2), ($4 > 0.3), $NF }' rows.tsv
ss-trade --need x=0.1 rate-and-state-mild
ss-trade --need f=0.04,a=0.1 rate-and-state-mild
ss-trade --need x=1e-3 -s law=slip -s duration=40 -s rate=50 rate-and-state-lab
