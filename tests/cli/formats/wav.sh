# WAV files made here byte by byte, of every type that is read: the same values, a column a channel.
byte() { for b in "$@"; do printf '%b' "\\0$(printf %o "$b")"; done; }
le() {      # WIDTH VALUE ...: little-endian
    width=$1; shift
    for v in "$@"; do
        i=0
        while [ "$i" -lt "$width" ]; do byte $((v >> 8 * i & 255)); i=$((i + 1)); done
    done
}
fmt() { printf 'fmt '; le 4 16; le 2 "$1" "$2"; le 4 8000 0; le 2 0 "$3"; }     # CODE CHANNELS BITS
riff() { printf RIFF; le 4 "$1"; printf WAVE; }
data() { printf data; le 4 "$1"; }
rows() { ss-cat "$@" | grep -v '^# start'; }

echo '-- PCM: 0, 1/2, -1 and one step below 1'
{ riff 40; fmt 1 1 8; data 4; byte 128 192 0 255; } > pcm8.wav
{ riff 44; fmt 1 1 16; data 8; le 2 0 16384 32768 32767; } > pcm16.wav
{ riff 48; fmt 1 1 24; data 12; le 3 0 4194304 8388608 8388607; } > pcm24.wav
{ riff 52; fmt 1 1 32; data 16; le 4 0 1073741824 2147483648 2147483647; } > pcm32.wav
for bits in 8 16 24 32; do rows pcm$bits.wav; done
echo '-- floating point: 1.5 and -2, stereo, behind chunks of other things, one of them of odd length'
{ riff 0; printf LIST; le 4 3; printf abc; byte 0; fmt 3 2 32; printf fact; le 4 4; le 4 1; data 8
  le 4 0x3fc00000 0xc0000000; printf 'LIST'; le 4 4; printf 'tail'; } > float.wav
rows float.wav
rows - --column ch2 < float.wav
{ riff 0; fmt 3 1 64; data 16; le 4 0 0x3ff80000 0 0xc0000000; } > double.wav
rows double.wav
echo '-- extensible, as Windows writes more than 16 bits; and of unknown length, as a pipe gives it'
{ riff 0; printf 'fmt '; le 4 40; le 2 65534 1; le 4 8000 0; le 2 3 24 22 24; le 4 4; le 2 1 0 0 16 128
  byte 0 170 0 56 155 113; data 3; le 3 4194304; byte 0; } > extensible.wav
rows extensible.wav
{ riff 0xffffffff; fmt 1 1 16; data 0xffffffff; le 2 16384; } > pipe.wav
rows pipe.wav
{ riff 44; fmt 1 1 16; data 0; printf 'LIST'; le 4 4; printf 'tail'; } > none.wav
rows none.wav
echo '-- what is refused'
{ riff 0; fmt 1 1 16; data 8; le 2 1 2; } > short.wav
{ riff 0; fmt 1 2 16; data 6; le 2 1 2 3; } > half.wav
{ riff 0; fmt 2 1 4; data 1; byte 0 0; } > adpcm.wav
{ riff 0; fmt 1 0 16; data 0; } > channels.wav
{ riff 0; data 2; le 2 1; } > no-format.wav
{ riff 0; fmt 1 1 16; printf LIST; le 4 0xfffffffe; } > endless.wav
{ riff 0; printf 'fmt '; le 4 4; le 4 1; } > tiny.wav
{ riff 0; fmt 3 1 32; data 4; le 4 0x7fc00000; } > nan.wav
riff 0 > bare.wav
for f in short half adpcm channels no-format endless tiny nan bare; do
    ss-cat $f.wav > out || echo "exit $?"
done
ss-cat --rate 44100 pcm8.wav > out || echo "exit $?"
# a length that is too small, or 0, is not believed; nor is a frame of another size
{ riff 0; fmt 1 1 16; data 2; le 2 1 2 3; } > small.wav
{ riff 36; fmt 1 1 16; data 0; le 2 0 1 2; } > zero.wav
{ riff 0; fmt 1 1 8; data 1; byte 192 0 0 0 0 0; } > small-odd.wav
{ riff 0; printf 'fmt '; le 4 16; le 2 1 2; le 4 8000 0; le 2 8 24; data 8; le 4 1 2; } > wide.wav
for bits in 0 7 64 65535; do { riff 0; fmt 1 1 "$bits"; data 8; le 4 0 0; } > "bits$bits.wav"; done
{ riff 0; fmt 1 65535 16; data 8; le 4 0 0; } > many.wav
for f in small zero small-odd wide bits0 bits7 bits64 bits65535 many; do ss-cat $f.wav > out || echo "exit $?"; done
# what follows the data are chunks up to the end, or samples that look like the name of one
{ riff 0; fmt 1 1 8; data 1; byte 192 0; printf LIST; le 4 1; byte 7 0; printf 'id3 '; le 4 3; byte 1 2 3; } > chunks.wav
{ riff 0; fmt 1 1 16; data 4; printf 'abcdefghijklmnop'; } > letters.wav
{ riff 0; fmt 1 1 16; data 4; le 2 1 2; printf LIST; le 4 9; byte 1 2 3; } > long.wav
{ riff 0; fmt 1 1 16; data 4; le 2 1 2; printf LIST; le 2 0; } > half-chunk.wav
{ riff 0; fmt 1 1 16; data 4; le 2 1 2; byte 1; printf 'bcd'; le 4 0; } > no-name.wav
rows chunks.wav
for f in letters long half-chunk no-name; do ss-cat $f.wav > out || echo "exit $?"; done
