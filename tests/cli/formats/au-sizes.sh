# An AU header may leave its size at 0, or give less than there is: nothing is lost without a word.
header() { printf '.snd\0\0\0\030'"$1"'\0\0\0\002\0\0\003\350\0\0\0\001'; }    # PCM of 8 bits at 1000 Hz
{ header '\0\0\0\0'; printf '@ @ '; } | ss-cat
{ header '\0\0\0\04'; printf '@ @ '; } | ss-cat | tail -n 1
{ header '\0\0\0\02'; printf '@ @ '; } > more.au
ss-cat more.au || echo $?
head -c 26 more.au | ss-cat | tail -n 1
{ header '\0\0\0\05'; printf '@ @ '; } | ss-cat || echo $?
header '\0\0\0\0' | ss-cat
