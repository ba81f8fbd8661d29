# The library keeps no global state, bar the lock around FFTW's planner, and calls nothing that
# changes the process, prints, ends it, or is not for threads.
[ -z "$SAN" ] || { echo "sanitizers have state of their own"; exit 77; }
case $CCLD in *--coverage*) echo "gcov has state of its own"; exit 77 ;; esac
objdump -t "$BUILD/libstickslip.a" > symbols 2> /dev/null || { echo "no objdump"; exit 77; }
grep -q 'elf' symbols || { echo "no ELF library"; exit 77; }
awk '/ O (\.data|\.bss|\*COM\*)/ && !/\.data\.rel\.ro/ { print "state:", $NF }' symbols
nm -u "$BUILD/libstickslip.a" | awk '$1 == "U" { print $2 }' | sort -u > called
for name in setlocale exit _exit abort printf vprintf puts putchar stdout stderr perror __assert_fail \
        fork system popen signal sigaction getenv setenv chdir umask gsl_set_error_handler_off \
        gsl_set_error_handler strtok strerror rand srand localtime gmtime asctime ctime tmpnam; do
    ! grep -qx "$name" called || echo "calls $name"
done
