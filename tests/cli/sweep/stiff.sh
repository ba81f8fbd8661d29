# A point whose forcing cycle costs too much is refused soon, with its reason.
# shellcheck disable=SC3045  # POSIX has only ulimit -f, but every sh here limits CPU time
(ulimit -t "${SAN:+10}4"; exec ss-sweep -m amplitude -y friction=1e12:1e12:1 --method rk8pd state-variable) > rows
grep -v '^#' rows | cut -f 1,2,4 | sed 's/ at t = .*: / at t = ...: /'
