/* deflate.c -- doubles as the filters shuffle and deflate keep them: a zlib stream (RFC 1950, 1951) of
 * all first bytes, then all second bytes, and so on.
 *
 * zlib treats all bytes alike.  Of rounded doubles each of these planes is of another kind, and gets
 * a block of its own: bytes that are all equal become one run, noise is stored, and the others get
 * a Huffman code, with matches where these make the block shorter.  That is a few times faster. */
#include "store/deflate.h"

#include <stdlib.h>
#include <string.h>

enum {
    LITERALS = 286, DISTANCES = 30, LENGTHS = 19,       /* symbols of the three alphabets */
    END = 256,                                          /* the symbol at the end of a block */
    NEAR_MATCH = 3, FAR_MATCH = 5, LONGEST = 258, WINDOW = 32768
};

/* --- bits ---------------------------------------------------------------------------------- */

typedef struct bits {
    unsigned char *to;
    uint64_t held;              /* n < 32 bits that are not in *to yet */
    unsigned n;
} bits;

static inline void
put(bits *b, uint32_t value, unsigned n)
{
    b->held |= (uint64_t)value << b->n;
    b->n += n;
    if (b->n < 32)
        return;
    for (int i = 0; i < 4; i++)
        b->to[i] = (unsigned char)(b->held >> 8 * i);
    b->to += 4;
    b->held >>= 32;
    b->n -= 32;
}

static void
end_byte(bits *b)
{
    for (; b->n > 0; b->n = b->n > 8 ? b->n - 8 : 0, b->held >>= 8)
        *b->to++ = (unsigned char)b->held;
}

static unsigned
log2_of(uint32_t x)
{
#if defined(__GNUC__)
    return 31 - (unsigned)__builtin_clz(x);
#else
    unsigned n = 0;
    while (x >>= 1)
        n++;
    return n;
#endif
}

/* --- codes --------------------------------------------------------------------------------- */

typedef struct code {
    unsigned char length[LITERALS + 2];
    uint16_t word[LITERALS + 2];
} code;

static int
ascending(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* The depths of the Huffman tree of n >= 2 weights that ascend; returns the largest. */
static unsigned
tree_depths(const uint32_t weight[], size_t n, unsigned char depth[])
{
    uint32_t node[LITERALS];            /* weights of inner nodes, which ascend, too */
    uint16_t parent[2 * LITERALS];      /* of leaves, then of inner nodes */
    size_t leaf = 0, inner = 0;
    for (size_t k = 0; k + 1 < n; k++) {
        node[k] = 0;
        for (int child = 0; child < 2; child++) {
            int is_leaf = leaf < n && (inner >= k || weight[leaf] <= node[inner]);
            node[k] += is_leaf ? weight[leaf] : node[inner];
            parent[is_leaf ? leaf++ : n + inner++] = (uint16_t)k;
        }
    }
    unsigned char inner_depth[LITERALS] = { 0 };
    for (size_t k = n - 2; k-- > 0;)
        inner_depth[k] = (unsigned char)(inner_depth[parent[n + k]] + 1);
    for (size_t i = 0; i < n; i++)
        depth[i] = (unsigned char)(inner_depth[parent[i]] + 1);
    return depth[0];
}

/* Words of the lengths, as RFC 1951 counts them, their first bit lowest. */
static void
make_words(code *c, size_t n)
{
    unsigned next = 0;
    for (unsigned length = 1; length <= 15; length++, next <<= 1)
        for (size_t i = 0; i < n; i++)
            if (c->length[i] == length) {
                unsigned word = 0;
                for (unsigned k = 0; k < length; k++)
                    word |= (next >> k & 1) << (length - 1 - k);
                c->word[i] = (uint16_t)word;
                next++;
            }
}

/* A code for n symbols that occur so often, of words of at most `most` bits.  There are at least two
 * words, as inflate needs. */
static void
make_code(code *c, const uint32_t times[], size_t n, unsigned most)
{
    uint32_t key[LITERALS], weight[LITERALS];
    unsigned char depth[LITERALS];
    size_t used = 0;
    memset(c->length, 0, sizeof c->length);
    for (size_t i = 0; i < n; i++)
        if (times[i] > 0)
            key[used++] = times[i] << 9 | (uint32_t)i;
    for (size_t i = 0; used < 2; i++)
        if (times[i] == 0)
            key[used++] = 1 << 9 | (uint32_t)i;
    qsort(key, used, sizeof *key, ascending);
    for (size_t i = 0; i < used; i++)
        weight[i] = key[i] >> 9;
    while (tree_depths(weight, used, depth) > most)
        for (size_t i = 0; i < used; i++)       /* flatter, in the same order */
            weight[i] = weight[i] / 2 + 1;
    for (size_t i = 0; i < used; i++)
        c->length[key[i] & 511] = depth[i];
    make_words(c, n);
}

/* --- blocks -------------------------------------------------------------------------------- */

/* A block of tokens: a byte, or a match as length << 15 | distance - 1. */
typedef struct block {
    uint32_t literal[LITERALS], distance[DISTANCES];    /* how often each symbol occurs */
    size_t extra;               /* bits behind symbols */
    uint32_t *token;
    size_t n;
} block;

static inline unsigned
length_bits(unsigned length)
{
    return length < 11 || length == LONGEST ? 0 : log2_of(length - 3) - 2;
}

static inline unsigned
length_symbol(unsigned length)
{
    unsigned extra = length_bits(length);
    return length == LONGEST ? 285 : 257 + (extra << 2) + ((length - 3) >> extra);
}

static inline unsigned
distance_bits(unsigned before)
{
    return before < 4 ? 0 : log2_of(before) - 1;
}

static inline unsigned
distance_symbol(unsigned before)
{
    unsigned extra = distance_bits(before);
    return 2 * extra + (before >> extra);
}

static inline void
add_literal(block *b, unsigned char byte)
{
    b->token[b->n++] = byte;
    b->literal[byte]++;
}

static inline void
add_match(block *b, unsigned length, unsigned before)
{
    b->token[b->n++] = length << 15 | before;
    b->literal[length_symbol(length)]++;
    b->distance[distance_symbol(before)]++;
    b->extra += length_bits(length) + distance_bits(before);
}

/* The lengths of both codes, the second behind the first, in the words for lengths: { symbol, what
 * follows }. */
static size_t
shorten_lengths(const unsigned char length[], size_t n, unsigned char run[][2])
{
    size_t runs = 0;
    for (size_t i = 0, same; i < n; i += same) {
        for (same = 1; i + same < n && length[i + same] == length[i]; same++)
            ;
        if (length[i] == 0 && same >= 3) {
            same = same < 138 ? same : 138;
            run[runs][0] = same < 11 ? 17 : 18;
            run[runs++][1] = (unsigned char)(same - (same < 11 ? 3 : 11));
        } else if (i > 0 && length[i] == length[i - 1] && same >= 3) {
            same = same < 6 ? same : 6;
            run[runs][0] = 16;
            run[runs++][1] = (unsigned char)(same - 3);
        } else {
            same = 1;
            run[runs][0] = length[i];
            run[runs++][1] = 0;
        }
    }
    return runs;
}

static void
put_codes(bits *b, const code *literal, const code *distance)
{
    static const unsigned char order[LENGTHS] = { 16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2,
                                                  14, 1, 15 };
    unsigned char all[LITERALS + DISTANCES], run[LITERALS + DISTANCES][2];
    uint32_t times[LENGTHS] = { 0 };
    code c;
    memcpy(all, literal->length, LITERALS);
    memcpy(all + LITERALS, distance->length, DISTANCES);
    size_t n = shorten_lengths(all, sizeof all, run);
    for (size_t i = 0; i < n; i++)
        times[run[i][0]]++;
    make_code(&c, times, LENGTHS, 7);
    put(b, LITERALS - 257, 5);
    put(b, DISTANCES - 1, 5);
    put(b, LENGTHS - 4, 4);
    for (int i = 0; i < LENGTHS; i++)
        put(b, c.length[order[i]], 3);
    for (size_t i = 0; i < n; i++) {
        unsigned symbol = run[i][0];
        put(b, c.word[symbol], c.length[symbol]);
        put(b, run[i][1], symbol == 16 ? 2 : symbol == 17 ? 3 : symbol == 18 ? 7 : 0);
    }
}

static void
put_tokens(bits *b, const block *of, const code *literal, const code *distance)
{
    for (size_t i = 0; i < of->n; i++) {
        unsigned length = of->token[i] >> 15, before = of->token[i] & (WINDOW - 1);
        unsigned symbol = length == 0 ? before : length_symbol(length);
        put(b, literal->word[symbol], literal->length[symbol]);
        if (length == 0)
            continue;
        unsigned extra = length_bits(length);
        put(b, (length - 3) & ((1u << extra) - 1), extra);
        symbol = distance_symbol(before);
        put(b, distance->word[symbol], distance->length[symbol]);
        extra = distance_bits(before);
        put(b, before & ((1u << extra) - 1), extra);
    }
    put(b, literal->word[END], literal->length[END]);
}

static size_t
cost(const block *of, const code *literal, const code *distance)
{
    size_t n = of->extra;
    for (size_t i = 0; i < LITERALS; i++)
        n += (size_t)of->literal[i] * literal->length[i];
    for (size_t i = 0; i < DISTANCES; i++)
        n += (size_t)of->distance[i] * distance->length[i];
    return n;
}

static void
put_stored(bits *b, const unsigned char *bytes, size_t n)
{
    for (size_t m; n > 0; n -= m, bytes += m) {
        m = n < 65535 ? n : 65535;
        put(b, 0, 3);
        end_byte(b);
        put(b, (uint32_t)m, 16);
        put(b, ~(uint32_t)m & 65535, 16);
        memcpy(b->to, bytes, m);
        b->to += m;
    }
}

/* A block that the bytes may be stored in instead: NULL, if the tokens are of other bytes. */
static void
put_block(bits *b, block *of, const unsigned char *bytes, size_t n)
{
    code literal, distance;
    of->literal[END] = 1;
    make_code(&literal, of->literal, LITERALS, 15);
    make_code(&distance, of->distance, DISTANCES, 15);
    if (bytes != NULL && cost(of, &literal, &distance) / 8 + 100 > n) {
        put_stored(b, bytes, n);
        return;
    }
    put(b, 2 << 1, 3);
    put_codes(b, &literal, &distance);
    put_tokens(b, of, &literal, &distance);
}

/* --- planes -------------------------------------------------------------------------------- */

static unsigned
match_length(const unsigned char *a, const unsigned char *b, size_t most)
{
    unsigned n = 0;
    while (n < most && a[n] == b[n])
        n++;
    return n;
}

/* How far back the last bytes are that begin as these do, and WINDOW at most; else 0.  place has the last
 * place of each hash, but for multiples of 2^16. */
static size_t
look_back(uint16_t place[], const unsigned char *p, size_t i)
{
    uint32_t four = (uint32_t)p[i] | (uint32_t)p[i + 1] << 8 | (uint32_t)p[i + 2] << 16
        | (uint32_t)p[i + 3] << 24;
    uint16_t *last = &place[four * 2654435761u >> (32 - DEFLATE_HASH)];
    size_t back = (uint16_t)(i - *last);
    *last = (uint16_t)i;
    return back <= i && back <= WINDOW ? back : 0;
}

/* Bytes and matches: a run of the byte before, or the last bytes that begin alike, if they are longer. */
static void
find_tokens(block *of, uint16_t place[], const unsigned char *p, size_t n)
{
    memset(place, 0, sizeof *place << DEFLATE_HASH);
    for (size_t i = 0, length; i < n; i += length) {
        size_t most = n - i < LONGEST ? n - i : LONGEST;
        size_t back = most >= FAR_MATCH ? look_back(place, p, i) : 0;
        size_t run = i > 0 ? match_length(p + i, p + i - 1, most) : 0;
        length = back > 1 && run < 2 * FAR_MATCH ? match_length(p + i, p + i - back, most) : 0;
        if (length >= FAR_MATCH && length > run + 1)
            add_match(of, (unsigned)length, (unsigned)back - 1);
        else if ((length = run) >= NEAR_MATCH)
            add_match(of, (unsigned)run, 0);
        else
            add_literal(of, p[i]), length = 1;
    }
}

/* Are matches worth the search?  They are if they leave out a sixteenth of the bytes at the start. */
static int
has_matches(deflater *d, size_t n)
{
    size_t part = n < 4096 ? n : 4096, saved = 0;
    block of = { .token = d->token };
    find_tokens(&of, d->place, d->plane, part);
    for (size_t i = 0; i < of.n; i++)
        if (of.token[i] >= LITERALS)
            saved += (of.token[i] >> 15) - (of.token[i] % WINDOW == 0 ? 1 : NEAR_MATCH);
    return 16 * saved > part;
}

static void
put_plane(bits *b, deflater *d, size_t n)
{
    int search = has_matches(d, n);
    block of = { .token = d->token };
    if (search)
        find_tokens(&of, d->place, d->plane, n);
    for (size_t i = 0; !search && i < n; i++)
        add_literal(&of, d->plane[i]);
    put_block(b, &of, d->plane, n);
}

/* n times the same byte. */
static void
put_run(bits *b, deflater *d, unsigned char byte, size_t n)
{
    block of = { .token = d->token };
    size_t length = 1;
    add_literal(&of, byte);
    for (n--; n > 0; n -= length) {
        length = n < LONGEST ? n : LONGEST;
        if (length >= NEAR_MATCH)
            add_match(&of, (unsigned)length, 0);
        else
            add_literal(&of, byte), length = 1;
    }
    put_block(b, &of, NULL, 0);
}

/* --- the stream ---------------------------------------------------------------------------- */

typedef struct adler {          /* the check sum of RFC 1950 */
    uint32_t a, b;
} adler;

enum { ADLER = 65521, SUMMED = 32, PART = 4096 };       /* sums over PART bytes fit into 32 bits */

static void
sum_plane(adler *s, const unsigned char *p, size_t n)
{
    for (size_t m; n > 0; n -= m, p += m) {
        size_t i = 0;
        m = n < PART ? n : PART;
        for (; i + SUMMED <= m; i += SUMMED) {
            uint32_t sum = 0, weighted = 0;
            for (uint32_t k = 0; k < SUMMED; k++) {
                sum += p[i + k];
                weighted += (SUMMED - k) * p[i + k];
            }
            s->b += SUMMED * s->a + weighted;
            s->a += sum;
        }
        for (; i < m; i++)
            s->b += s->a += p[i];
        s->a %= ADLER;
        s->b %= ADLER;
    }
}

/* The same for a run. */
static void
sum_run(adler *s, uint64_t byte, uint64_t n)
{
    s->b = (uint32_t)((s->b + n * s->a + byte * (n * (n + 1) / 2)) % ADLER);
    s->a = (uint32_t)((s->a + byte * n) % ADLER);
}

size_t
ss_deflate_doubles(deflater *d, const double *x, size_t n)
{
    bits b = { .to = d->out };
    adler sum = { 1, 0 };
    uint64_t differ = 0;
    memcpy(d->word, x, n * sizeof *x);
    for (size_t i = 0; i < n; i++)
        differ |= d->word[i] ^ d->word[0];
    put(&b, 0x0178, 16);                /* a window of 32 KB, the fastest level */
    for (unsigned shift = 0; shift < 64; shift += 8) {
        unsigned char byte = (unsigned char)(d->word[0] >> shift);
        if ((unsigned char)(differ >> shift) == 0) {
            put_run(&b, d, byte, n);
            sum_run(&sum, byte, n);
            continue;
        }
        for (size_t i = 0; i < n; i++)
            d->plane[i] = (unsigned char)(d->word[i] >> shift);
        put_plane(&b, d, n);
        sum_plane(&sum, d->plane, n);
    }
    put(&b, 3, 3);                      /* the last block, of no byte, with fixed codes */
    put(&b, 0, 7);
    end_byte(&b);
    for (unsigned i = 0; i < 4; i++)
        *b.to++ = (unsigned char)((i < 2 ? sum.b : sum.a) >> (i % 2 == 0 ? 8 : 0));
    return (size_t)(b.to - d->out);
}
