# -v says what was chosen and what it cost.
ss-signal sine --duration 3 | ss-morlet -v --method quadrature 2>&1 > /dev/null | sed -e '/of CPU/d' -e 's/, [^,]* s$/, TIME s/'
ss-morlet --version | grep -c 'ss-morlet (libstickslip)'
ss-morlet --help | awk 'length > 80 { print "too wide: " $0 } END { if (NR > 24) print NR " lines" }'
ss-morlet --help > /dev/null
ss-signal sine --rate 200 --duration 2 | ss-morlet -v --stream --fmin 0.02 2>&1 > /dev/null | grep behind
