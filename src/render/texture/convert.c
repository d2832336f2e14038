#include "render/texture/convert.h"

#include "base/bits.h"
#include "base/half.h"
#include "base/minmax.h"
#include "machine/cpu.h"

#include <immintrin.h>
#include <math.h>
#include <string.h>

/* Texels that are converted together where one conversion follows another. */
enum { CHUNK = 64 };

/* --- Bytes: four texels at a time --- */

struct scale {
    uint16_t multiplier, addend;
    uint8_t drop;
};

/* From n bits to 8, and from 8 bits to n. */
static const struct scale expand[9] = {{0, 0, 0},    {255, 0, 0},  {85, 0, 0},  {73, 0, 1}, {17, 0, 0},
                                       {527, 23, 6}, {259, 33, 6}, {129, 0, 6}, {1, 0, 0}};
static const struct scale reduce[9] = {{0, 0, 0},       {1, 0, 7},    {3, 129, 8},
                                       {225, 4060, 13}, {15, 135, 8}, {249, 1014, 11},
                                       {253, 505, 10},  {1, 0, 1},    {1, 0, 0}};

/* A channel's path: v = (word >> from & mask), then the scale, then << to. */
struct path {
    __m128i from, mask, multiplier, addend, drop, to;
};

struct paths {
    struct path path[4];
    int count;
    __m128i constant; /* what is in every result */
};

static __m128i count_of(unsigned bits)
{
    return _mm_cvtsi32_si128((int)bits);
}

static void add_path(struct paths *paths, unsigned from, unsigned bits, const struct scale *scale,
                     unsigned to)
{
    paths->path[paths->count++] = (struct path){count_of(from),
                                                _mm_set1_epi32((1 << bits) - 1),
                                                _mm_set1_epi32(scale->multiplier),
                                                _mm_set1_epi32(scale->addend),
                                                count_of(scale->drop),
                                                count_of(to)};
}

static struct paths decoding_paths(const struct format *format)
{
    struct paths paths = {.count = 0};
    uint32_t constant = 0;
    for (unsigned c = 0; c < 4; c++) {
        const struct channel *channel = &format->channel[c];
        if (channel->type == CHANNEL_UNSIGNED)
            add_path(&paths, channel->shift, channel->bits, &expand[channel->bits], 8 * c);
        else if (channel->type == CHANNEL_ONE)
            constant |= 255u << 8 * c;
    }
    paths.constant = _mm_set1_epi32((int)constant);
    return paths;
}

static struct paths encoding_paths(const struct format *format)
{
    struct paths paths = {.count = 0, .constant = _mm_setzero_si128()};
    for (unsigned c = 0; c < 4; c++)
        if (format_channel_is_stored(format, c))
            add_path(&paths, 8 * c, 8, &reduce[format->channel[c].bits], format->channel[c].shift);
    return paths;
}

static inline __m128i follow(const struct paths *paths, __m128i words)
{
    __m128i result = paths->constant;
    for (int i = 0; i < paths->count; i++) {
        const struct path *p = &paths->path[i];
        __m128i v = _mm_and_si128(_mm_srl_epi32(words, p->from), p->mask);
        v = _mm_add_epi32(_mm_madd_epi16(v, p->multiplier), p->addend);
        result = _mm_or_si128(result, _mm_sll_epi32(_mm_srl_epi32(v, p->drop), p->to));
    }
    return result;
}

/* Four texels of `bytes` bytes, 1 to 4, as words, and back. */
static inline __m128i gather(const uint8_t *data, unsigned bytes)
{
    __m128i zero = _mm_setzero_si128();
    uint32_t word[4] = {0};
    if (bytes == 4)
        return _mm_loadu_si128((const __m128i *)(const void *)data);
    if (bytes == 2)
        return _mm_unpacklo_epi16(_mm_loadl_epi64((const __m128i *)(const void *)data), zero);
    if (bytes == 1) {
        memcpy(word, data, 4);
        return _mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128((int)word[0]), zero), zero);
    }
    for (unsigned i = 0; i < 4; i++)
        memcpy(word + i, data + 3 * i, 3);
    return _mm_loadu_si128((const __m128i *)word);
}

static inline void scatter(uint8_t *data, unsigned bytes, __m128i words)
{
    uint32_t word[4];
    if (bytes == 4) {
        _mm_storeu_si128((__m128i *)(void *)data, words);
        return;
    }
    /* Packing saturates signed words, so those of 16 bits get their highest bit as their sign. */
    __m128i pairs = _mm_packs_epi32(_mm_srai_epi32(_mm_slli_epi32(words, 16), 16), words);
    if (bytes == 2) {
        _mm_storel_epi64((__m128i *)(void *)data, pairs);
        return;
    }
    if (bytes == 1) {
        int four = _mm_cvtsi128_si32(_mm_packus_epi16(pairs, pairs));
        memcpy(data, &four, sizeof four);
        return;
    }
    _mm_storeu_si128((__m128i *)word, words);
    for (unsigned i = 0; i < 4; i++)
        memcpy(data + 3 * i, word + i, 3);
}

static void convert_bytes(const struct paths *paths, const uint8_t *from, unsigned from_bytes, uint8_t *to,
                          unsigned to_bytes, uint32_t count)
{
    uint8_t in[16] = {0}, out[16];
    for (; count >= 4; count -= 4, from += 4 * from_bytes, to += 4 * to_bytes)
        scatter(to, to_bytes, follow(paths, gather(from, from_bytes)));
    if (!count)
        return;
    memcpy(in, from, count * from_bytes);
    scatter(out, to_bytes, follow(paths, gather(in, from_bytes)));
    memcpy(to, out, count * to_bytes);
}

/* The first eights of exchange_words(); returns how many words they are. */
__attribute__((target("avx2"))) static uint32_t exchange_eights(const uint8_t *from, uint8_t *to,
                                                                uint32_t count, uint32_t kept, uint32_t set)
{
    const __m256i order = _mm256_broadcastsi128_si256(
        _mm_set_epi8(15, 12, 13, 14, 11, 8, 9, 10, 7, 4, 5, 6, 3, 0, 1, 2)); /* of the bytes */
    const __m256i some = _mm256_set1_epi32((int)kept), ones = _mm256_set1_epi32((int)set);
    uint32_t i = 0;
    for (; i + 8 <= count; i += 8) {
        __m256i w = _mm256_loadu_si256((const __m256i *)(const void *)(from + 4 * i));
        w = _mm256_or_si256(_mm256_and_si256(_mm256_shuffle_epi8(w, order), some), ones);
        _mm256_storeu_si256((__m256i *)(void *)(to + 4 * i), w);
    }
    return i;
}

/* Exchanges red and blue of words, keeps the bits `kept` and sets the bits `set`. */
static void exchange_words(const uint8_t *from, uint8_t *to, uint32_t count, uint32_t kept, uint32_t set)
{
    const __m128i middle = _mm_set1_epi32((int)(0xff00ff00 & kept)), outer = _mm_set1_epi32(0x00ff00ff);
    const __m128i ones = _mm_set1_epi32((int)set);
    uint32_t i = cpu_has_avx2_fma() ? exchange_eights(from, to, count, kept, set) : 0;
    for (; i + 4 <= count; i += 4) {
        __m128i w = _mm_loadu_si128((const __m128i *)(const void *)(from + 4 * i));
        __m128i exchanged = _mm_and_si128(w, outer);
        exchanged = _mm_shufflehi_epi16(_mm_shufflelo_epi16(exchanged, 0xb1), 0xb1); /* halves of words */
        w = _mm_or_si128(_mm_or_si128(_mm_and_si128(w, middle), ones), exchanged);
        _mm_storeu_si128((__m128i *)(void *)(to + 4 * i), w);
    }
    for (; i < count; i++) {
        uint32_t w;
        memcpy(&w, from + 4 * i, 4);
        w = (w & 0xff00ff00 & kept) | (w & 255) << 16 | (w >> 16 & 255) | set;
        memcpy(to + 4 * i, &w, 4);
    }
}

static bool is_byte_at(const struct channel *channel, unsigned shift)
{
    return channel->type == CHANNEL_UNSIGNED && channel->bits == 8 && channel->shift == shift;
}

/* Returns true for words whose channels are bytes with blue lowest: A8R8G8B8, X8R8G8B8. */
static bool is_exchanged(const struct format *format)
{
    return format->bytes == 4 && is_byte_at(&format->channel[0], 16) && is_byte_at(&format->channel[1], 8) &&
           is_byte_at(&format->channel[2], 0) &&
           (is_byte_at(&format->channel[3], 24) || format->channel[3].type == CHANNEL_ONE);
}

/* Returns true if the bytes of a texel are those of its stored word: A8B8G8R8. */
static bool is_stored_word(const struct format *format)
{
    return format->bytes == 4 && is_byte_at(&format->channel[0], 0) && is_byte_at(&format->channel[1], 8) &&
           is_byte_at(&format->channel[2], 16) && is_byte_at(&format->channel[3], 24);
}

bool format_is_words(const struct format *format, struct format_words *words)
{
    words->exchanged = is_exchanged(format);
    words->kept = format->channel[3].type == CHANNEL_ONE ? 0x00ffffff : 0xffffffff;
    return format->storage == STORAGE_RGBA8 && (words->exchanged || is_stored_word(format));
}

static void decode_bytes(const struct format *format, const void *data, uint32_t count, void *texels)
{
    bool opaque = format->channel[3].type == CHANNEL_ONE;
    if (is_stored_word(format)) {
        memcpy(texels, data, 4 * (size_t)count);
    } else if (is_exchanged(format)) {
        exchange_words(data, texels, count, opaque ? 0x00ffffff : 0xffffffff, opaque ? 0xff000000 : 0);
    } else {
        struct paths paths = decoding_paths(format);
        convert_bytes(&paths, data, format->bytes, texels, 4, count);
    }
}

static void encode_bytes(const struct format *format, const void *texels, uint32_t count, void *data)
{
    struct format_words words;
    if (!format_is_words(format, &words)) {
        struct paths paths = encoding_paths(format);
        convert_bytes(&paths, texels, 4, data, format->bytes, count);
    } else if (words.exchanged) {
        exchange_words(texels, data, count, words.kept, 0);
    } else {
        memcpy(data, texels, 4 * (size_t)count);
    }
}

/* --- Numbers --- */

/* The bits of a block of at most 16 bytes. No channel crosses the words. */
struct bits {
    uint64_t word[2];
};

static inline struct bits load_bits(const uint8_t *block, unsigned bytes)
{
    struct bits bits = {{0}};
    switch (bytes) {
    case 2: memcpy(bits.word, block, 2); break;
    case 4: memcpy(bits.word, block, 4); break;
    case 8: memcpy(bits.word, block, 8); break;
    case 16: memcpy(bits.word, block, 16); break;
    default: memcpy(bits.word, block, bytes); break;
    }
    return bits;
}

static inline void store_bits(const struct bits *bits, uint8_t *block, unsigned bytes)
{
    switch (bytes) {
    case 2: memcpy(block, bits->word, 2); break;
    case 4: memcpy(block, bits->word, 4); break;
    case 8: memcpy(block, bits->word, 8); break;
    case 16: memcpy(block, bits->word, 16); break;
    default: memcpy(block, bits->word, bytes); break;
    }
}

static inline uint32_t channel_mask(const struct channel *channel)
{
    return (uint32_t)((1ull << channel->bits) - 1);
}

/* The number 1 as an integer. */
static inline uint32_t channel_largest(const struct channel *channel)
{
    return channel_mask(channel) >> (channel->type == CHANNEL_SIGNED);
}

/* The integer that -1 is the negative of. */
static inline uint32_t channel_lowest(const struct channel *channel)
{
    return channel_largest(channel) + (channel->bits < 8);
}

static inline float decode_signed(const struct channel *channel, uint32_t bits)
{
    int unused = 32 - channel->bits;
    int32_t integer = (int32_t)(bits << unused) >> unused;
    double value = (double)integer / (integer < 0 ? channel_lowest(channel) : channel_largest(channel));
    return value < -1 ? -1 : (float)value;
}

static inline float decode_number(const struct channel *channel, const struct bits *block)
{
    if (channel->type == CHANNEL_ZERO || channel->type == CHANNEL_ONE)
        return channel->type == CHANNEL_ONE;
    uint32_t bits =
        (uint32_t)(block->word[channel->shift / 64] >> channel->shift % 64) & channel_mask(channel);
    if (channel->type == CHANNEL_UNSIGNED)
        return (float)((double)bits / channel_largest(channel));
    if (channel->type == CHANNEL_SIGNED)
        return decode_signed(channel, bits);
    return channel->bits == 16 ? half_to_float((uint16_t)bits) : bits_to_float(bits);
}

static void decode_numbers(const struct format *format, const uint8_t *data, uint32_t count, float *numbers)
{
    for (uint32_t i = 0; i < count; i++, data += format->bytes, numbers += 4) {
        struct bits block = load_bits(data, format->bytes);
        for (int c = 0; c < 4; c++)
            numbers[c] = decode_number(&format->channel[c], &block);
        if (format->coding == CODING_NORMAL) {
            double x = (double)numbers[0], y = (double)numbers[1];
            numbers[2] = (float)sqrt(fmax(1 - x * x - y * y, 0));
        }
    }
}

/* A NaN keeps the bits of its payload that binary16 has. */
static uint32_t encode_half(float number)
{
    uint32_t bits = bits_of_float(number), half = float_to_half(number);
    return isnan(number) && bits << 9 >> 22 ? (bits >> 16 & 0x8000) | 0x7c00 | bits << 9 >> 22 : half;
}

/* Nearest even; NaN is 0. */
static inline uint32_t encode_number(const struct channel *channel, float number)
{
    if (channel->type == CHANNEL_FLOAT)
        return channel->bits == 16 ? encode_half(number) : bits_of_float(number);
    double low = channel->type == CHANNEL_SIGNED ? -1 : 0;
    double inside = number >= 1 ? 1 : number > low ? number : isnan(number) ? 0 : low;
    double scale = inside < 0 ? channel_lowest(channel) : channel_largest(channel);
    return (uint32_t)_mm_cvtsd_si64(_mm_set_sd(inside * scale)) & channel_mask(channel);
}

static void encode_numbers(const struct format *format, const float *numbers, uint32_t count, uint8_t *data)
{
    bool stored[4];
    for (unsigned c = 0; c < 4; c++)
        stored[c] = format_channel_is_stored(format, c);
    for (uint32_t i = 0; i < count; i++, numbers += 4, data += format->bytes) {
        struct bits block = {{0}};
        for (int c = 0; c < 4; c++) {
            const struct channel *channel = &format->channel[c];
            if (stored[c])
                block.word[channel->shift / 64] |= (uint64_t)encode_number(channel, numbers[c])
                                                   << channel->shift % 64;
        }
        store_bits(&block, data, format->bytes);
    }
}

void format_numbers_of_bytes(const uint32_t *words, uint32_t count, float *numbers)
{
    const __m128i zero = _mm_setzero_si128();
    const __m128 most = _mm_set1_ps(255);
    for (uint32_t i = 0; i < count; i++) {
        __m128i bytes = _mm_unpacklo_epi8(_mm_cvtsi32_si128((int)words[i]), zero);
        _mm_storeu_ps(numbers + 4 * i, _mm_div_ps(_mm_cvtepi32_ps(_mm_unpacklo_epi16(bytes, zero)), most));
    }
}

/* --- Rows --- */

/* Returns true if a texel's bytes are its four stored numbers. */
static bool is_stored_numbers(const struct format *format)
{
    return format->bytes == 16 && format->side == 1 && format->channel[3].type == CHANNEL_FLOAT;
}

void format_decode_row(const struct format *format, const void *data, uint32_t count, void *texels)
{
    if (format->storage == STORAGE_RGBA8)
        decode_bytes(format, data, count, texels);
    else if (is_stored_numbers(format))
        memcpy(texels, data, 16 * (size_t)count);
    else
        decode_numbers(format, data, count, texels);
}

static void encode_bytes_as_numbers(const struct format *format, const uint32_t *words, uint32_t count,
                                    uint8_t *data)
{
    float numbers[4 * CHUNK];
    for (uint32_t i = 0; i < count; i += CHUNK) {
        uint32_t part = min_u32(CHUNK, count - i);
        format_numbers_of_bytes(words + i, part, numbers);
        encode_numbers(format, numbers, part, data + (size_t)i * format->bytes);
    }
}

void format_encode_row(const struct format *format, enum storage storage, const void *texels, uint32_t count,
                       void *data)
{
    if (storage == STORAGE_FLOAT4 && is_stored_numbers(format))
        memcpy(data, texels, 16 * (size_t)count);
    else if (storage == STORAGE_FLOAT4)
        encode_numbers(format, texels, count, data);
    else if (format->storage == STORAGE_RGBA8)
        encode_bytes(format, texels, count, data);
    else
        encode_bytes_as_numbers(format, texels, count, data);
}
