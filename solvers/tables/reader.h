/* Reader: the same operations as the reader in Python. */

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { @BIG@_OK = 0, @BIG@_OUTSIDE = 1, @BIG@_DAMAGED = 2 };
enum { @OUTCOMES@ };

/* What the table says of an impact. */
typedef struct {
    int outcome;                      /* @BIG@_STICK, ..., -1 outside the table */
    int criterion;                    /* first rebound criterion of a bounce: @CRITERIA@; else -1 */
    double value[@BIG@_RESULTS];     /* results in the order above; NaN where undefined, and outside the table */
} @NAME@_answer;

/* Derivatives of the results by the variables in the order above, the others held; SI units. */
typedef struct {
    double by[@BIG@_RESULTS][@BIG@_VARIABLES];
} @NAME@_slopes;

/* A value and its derivatives by t (third variable) and x (angle), coordinates in 0..1. */
typedef struct {
    double value, by_t, by_x;
} @NAME@_shape;

/* The map of a cell: coordinate, and its derivatives by w and by the least distance. */
typedef struct {
    double value, by_w, by_least;
} @NAME@_mapped;

/* Chebyshev polynomials, even and odd ones by recurrences of their own, which do not wait for each other. */
static inline void @NAME@_chebyshev(double x, int count, double *value)
{
    double second = 2.0 * x * x - 1.0, twice = 2.0 * second;
    int k;
    value[0] = 1.0;
    if (count > 1)
        value[1] = x;
    if (count > 2)
        value[2] = second;
    if (count > 3)
        value[3] = x * (twice - 1.0);
    for (k = 4; k < count; ++k)
        value[k] = twice * value[k - 2] - value[k - 4];
}

static inline void @NAME@_chebyshev_slope(double x, int count, const double *value, double *slope)
{
    int k;
    slope[0] = 0.0;
    if (count > 1)
        slope[1] = 1.0;
    for (k = 2; k < count; ++k)
        slope[k] = 2.0 * value[k - 1] + 2.0 * x * slope[k - 1] - slope[k - 2];
}

/* A boundary or an angle between panels; derivatives where `sloped`. */
static inline @NAME@_shape @NAME@_shape_at(int node, double t, double x, int sloped)
{
    double in_t[@BIG@_MOST], in_x[@BIG@_MOST], slope_t[@BIG@_MOST], slope_x[@BIG@_MOST];
    const double *c;
    const double *box;
    @NAME@_shape found = {0.0, 0.0, 0.0};
    int patch, count_t, count_x, i, j;
    while (@NAME@_shape_axis[node] >= 0)
        node = @NAME@_shape_child[node] + (x >= @NAME@_shape_cut[node]);
    patch = @NAME@_shape_child[node];
    count_t = @NAME@_shape_size[3 * patch];
    count_x = @NAME@_shape_size[3 * patch + 1];
    c = @NAME@_shape_series + @NAME@_shape_start[patch];
    if (count_t == 1 && count_x == 1) {
        found.value = c[0];
        return found;
    }
    box = @NAME@_shape_box + 4 * patch;
    t = 2.0 * t - 1.0;
    x = 2.0 * (x - box[0]) * box[2] - 1.0;
    @NAME@_chebyshev(t, count_t, in_t);
    @NAME@_chebyshev(x, count_x, in_x);
    for (i = 0; i < count_t; ++i) {
        double sum = 0.0;
        for (j = 0; j < count_x; ++j)
            sum += c[i * count_x + j] * in_x[j];
        found.value += in_t[i] * sum;
    }
    if (!sloped)
        return found;
    @NAME@_chebyshev_slope(t, count_t, in_t, slope_t);
    @NAME@_chebyshev_slope(x, count_x, in_x, slope_x);
    for (i = 0; i < count_t; ++i)
        for (j = 0; j < count_x; ++j) {
            found.by_t += 2.0 * c[i * count_x + j] * slope_t[i] * in_x[j];
            found.by_x += 2.0 * box[2] * c[i * count_x + j] * in_t[i] * slope_x[j];
        }
    return found;
}

/* g of maps: w, or a sum of sqrt(w) or ln(w) and of -sqrt(1 - w) or -ln(1 - w). */
static inline double @NAME@_raw(int low, int high, double w, double *slope)
{
    double v = w > 1e-30 ? w : 1e-30, u = 1.0 - w > 1e-30 ? 1.0 - w : 1e-30, value = 0.0;
    *slope = 0.0;
    if (low == 0 && high == 0) {
        *slope = 1.0;
        return w;
    }
    if (low == 1) {
        value = sqrt(v);
        *slope = 0.5 / value;
    } else if (low == 2) {
        value = log(v);
        *slope = 1.0 / v;
    }
    if (high == 1) {
        double root = sqrt(u);
        value -= root;
        *slope += 0.5 / root;
    } else if (high == 2) {
        value -= log(u);
        *slope += 1.0 / u;
    }
    return value;
}

static inline @NAME@_mapped @NAME@_map(int code, double w, double least)
{
    int low = code % 3, high = code / 3;
    double first = low == 2 ? least : 0.0, last = high == 2 ? least : 0.0, start, end, wide, slope, at_start, at_end;
    double inner = w < first ? first : w > 1.0 - last ? 1.0 - last : w;
    @NAME@_mapped found;
    if (code == 0) {
        found.value = w;
        found.by_w = 1.0;
        found.by_least = 0.0;
        return found;
    }
    start = @NAME@_raw(low, high, first, &at_start);
    end = @NAME@_raw(low, high, 1.0 - last, &at_end);
    found.value = @NAME@_raw(low, high, inner, &slope);
    wide = end - start;
    at_start = low == 2 ? at_start : 0.0;
    at_end = high == 2 ? -at_end : 0.0;
    found.value = (found.value - start) / wide;
    found.by_w = inner < w || inner > w ? 0.0 : slope / wide;
    found.by_least = (-at_start - found.value * (at_end - at_start)) / wide;
    return found;
}

/* Results at coordinates of a cell; with `by` also derivatives by t, x and z. */
static inline void @NAME@_results_at(int node, double t, double x, double z, double *value, double by[][3])
{
    double in_t[@BIG@_MOST], in_x[@BIG@_MOST], in_z[@BIG@_MOST], row[@BIG@_MOST];
    double slope_t[@BIG@_MOST], slope_x[@BIG@_MOST], slope_z[@BIG@_MOST];
    const @REAL@ *c;
    const double *box;
    int patch, count_t, count_x, count_z, i, j, k, m;
    while (@NAME@_axis[node] >= 0)
        node = @NAME@_child[node] + ((@NAME@_axis[node] == 0 ? x : z) >= @NAME@_cut[node]);
    patch = @NAME@_child[node];
    count_t = @NAME@_size[3 * patch];
    count_x = @NAME@_size[3 * patch + 1];
    count_z = @NAME@_size[3 * patch + 2];
    c = @NAME@_series + @NAME@_start[patch];
    box = @NAME@_box + 4 * patch;
    t = 2.0 * t - 1.0;
    x = 2.0 * (x - box[0]) * box[2] - 1.0;
    z = 2.0 * (z - box[1]) * box[3] - 1.0;
    @NAME@_chebyshev(t, count_t, in_t);
    @NAME@_chebyshev(x, count_x, in_x);
    @NAME@_chebyshev(z, count_z, in_z);
    for (m = 0; m < @BIG@_RESULTS; ++m) {
        const @REAL@ *own = c + m * count_t * count_x * count_z;
        for (k = 0; k < count_z; ++k)
            row[k] = 0.0;
        for (i = 0; i < count_t; ++i)
            for (j = 0; j < count_x; ++j) {
                double weight = in_t[i] * in_x[j];
                for (k = 0; k < count_z; ++k)
                    row[k] += weight * (double)own[k];
                own += count_z;
            }
        value[m] = 0.0;
        for (k = 0; k < count_z; ++k)
            value[m] += row[k] * in_z[k];
    }
    if (!by)
        return;
    @NAME@_chebyshev_slope(t, count_t, in_t, slope_t);
    @NAME@_chebyshev_slope(x, count_x, in_x, slope_x);
    @NAME@_chebyshev_slope(z, count_z, in_z, slope_z);
    for (m = 0; m < @BIG@_RESULTS; ++m) {
        by[m][0] = by[m][1] = by[m][2] = 0.0;
        for (i = 0; i < count_t; ++i)
            for (j = 0; j < count_x; ++j)
                for (k = 0; k < count_z; ++k) {
                    double one = (double)*c++;
                    by[m][0] += 2.0 * one * slope_t[i] * in_x[j] * in_z[k];
                    by[m][1] += 2.0 * box[2] * one * in_t[i] * slope_x[j] * in_z[k];
                    by[m][2] += 2.0 * box[3] * one * in_t[i] * in_x[j] * slope_z[k];
                }
    }
}

/* CRC-32 (as of zlib) of numbers as doubles, the least significant byte first. */
static inline uint32_t @NAME@_crc(uint32_t crc, double number)
{
    uint64_t bits;
    int k;
    memcpy(&bits, &number, sizeof bits);
    for (k = 0; k < 64; ++k, bits >>= 1)
        crc = (crc >> 1) ^ (((crc ^ (uint32_t)bits) & 1u) ? 0xedb88320u : 0u);
    return crc;
}

/* 1 if the numbers of this file are those that were written, computed once; else 0. */
static inline int @NAME@_is_sound(void)
{
    static int state = 0; /* 1 sound, 2 damaged; threads write the same */
    if (!state) {
        uint32_t crc = 0xffffffffu;
        size_t k;
#define @BIG@_SUM(array)                                          \
    for (k = 0; k < sizeof array / sizeof array[0]; ++k) \
    crc = @NAME@_crc(crc, (double)array[k])
@SUMS@
#undef @BIG@_SUM
        state = (crc ^ 0xffffffffu) == @CHECKSUM@ ? 1 : 2;
    }
    return state == 1;
}

/* The answer at an impact, with derivatives unless `slopes` is 0. */
static inline int @NAME@_read(double third, double angle, double stokes, @NAME@_answer *answer, @NAME@_slopes *slopes)
{
    const double nothing = HUGE_VAL - HUGE_VAL; /* NaN */
    double height, t, wide, across, w, tall, least, chain[3][3], by[@BIG@_RESULTS][3];
    @NAME@_shape low, high, floor_at, ceiling;
    @NAME@_mapped x, z;
    int part = 0, panel, last, edge, end, cell, m, k, sloped = slopes != 0;

    answer->outcome = answer->criterion = -1;
    for (m = 0; m < @BIG@_RESULTS; ++m) {
        answer->value[m] = nothing;
        for (k = 0; slopes && k < @BIG@_VARIABLES; ++k)
            slopes->by[m][k] = nothing;
    }
    if (!@NAME@_is_sound())
        return @BIG@_DAMAGED;
    if (!(stokes >= @NAME@_range[0] && stokes <= @NAME@_range[1] && angle >= @NAME@_range[2] &&
          angle <= @NAME@_range[3] && third >= @NAME@_range[4] && third <= @NAME@_range[5]))
        return @BIG@_OUTSIDE;

    height = log(stokes);
    while (part < @BIG@_SLICES - 1 && third >= @NAME@_slices[part + 1])
        ++part;
    wide = @NAME@_slices[part + 1] - @NAME@_slices[part];
    t = (third - @NAME@_slices[part]) / wide;
    panel = @NAME@_first_panel[part];
    last = @NAME@_first_panel[part + 1] - 1;
    low = @NAME@_shape_at(@NAME@_cuts[2 * panel], t, 0.0, sloped);
    high = @NAME@_shape_at(@NAME@_cuts[2 * panel + 1], t, 0.0, sloped);
    while (angle >= high.value && panel < last) {
        ++panel;
        low = high;
        high = @NAME@_shape_at(@NAME@_cuts[2 * panel + 1], t, 0.0, sloped);
    }
    across = (angle - low.value) / (high.value - low.value);
    across = across < 0.0 ? 0.0 : across > 1.0 ? 1.0 : across;
    x = @NAME@_map(@NAME@_maps[panel], across, 0.0);
    x.value = x.value < 0.0 ? 0.0 : x.value > 1.0 ? 1.0 : x.value;

    edge = @NAME@_first_edge[panel];
    end = @NAME@_first_edge[panel + 1];
    floor_at.value = @NAME@_height[0];
    ceiling.value = @NAME@_height[1];
    floor_at.by_t = floor_at.by_x = ceiling.by_t = ceiling.by_x = 0.0;
    for (; edge < end; ++edge) {
        @NAME@_shape found = @NAME@_shape_at(@NAME@_edges[edge], t, x.value, sloped);
        if (!(height >= found.value)) {
            ceiling = found;
            break;
        }
        floor_at = found;
    }
    cell = edge + panel;
    answer->outcome = @NAME@_outcome[cell];
    answer->criterion = @NAME@_criterion[cell];
    if (@NAME@_root[cell] < 0) {
        for (m = 0; m < @BIG@_RESULTS; ++m) {
            answer->value[m] = @NAME@_of_stick[m] ? nothing : 0.0;
            for (k = 0; slopes && k < @BIG@_VARIABLES; ++k)
                slopes->by[m][k] = @NAME@_of_stick[m] ? nothing : 0.0;
        }
        return @BIG@_OK;
    }
    tall = ceiling.value - floor_at.value;
    tall = tall > 1e-300 ? tall : 1e-300;
    w = (height - floor_at.value) / tall;
    w = w < 0.0 ? 0.0 : w > 1.0 ? 1.0 : w;
    least = tall > 1e-30 ? @LEAST@ / tall : 0.25;
    least = least < 0.25 ? least : 0.25;
    z = @NAME@_map(@NAME@_cell_map[cell], w, least);
    z.value = z.value < 0.0 ? 0.0 : z.value > 1.0 ? 1.0 : z.value;
    @NAME@_results_at(@NAME@_root[cell], t, x.value, z.value, answer->value, slopes ? by : 0);
    if (!slopes)
        return @BIG@_OK;

    {
        double x_by_t = -x.by_w * (low.by_t + across * (high.by_t - low.by_t)) / (high.value - low.value);
        double x_by_angle = x.by_w / (high.value - low.value);
        double grows_t = ceiling.by_t - floor_at.by_t, grows_x = ceiling.by_x - floor_at.by_x;
        double z_by_t = (-z.by_w * (floor_at.by_t + w * grows_t) - z.by_least * least * grows_t) / tall;
        double z_by_x = (-z.by_w * (floor_at.by_x + w * grows_x) - z.by_least * least * grows_x) / tall;
        chain[0][0] = z.by_w / tall; /* by ln St: z */
        chain[1][0] = z_by_x * x_by_angle;
        chain[1][1] = x_by_angle;
        chain[2][0] = (z_by_t + z_by_x * x_by_t) / wide;
        chain[2][1] = x_by_t / wide;
        chain[2][2] = 1.0 / wide;
    }
    for (m = 0; m < @BIG@_RESULTS; ++m) {
        double found[3];
        found[0] = by[m][2] * chain[0][0] / stokes;
        found[1] = by[m][2] * chain[1][0] + by[m][1] * chain[1][1];
        found[2] = by[m][2] * chain[2][0] + by[m][1] * chain[2][1] + by[m][0] * chain[2][2];
        for (k = 0; k < @BIG@_VARIABLES; ++k)
            slopes->by[m][k] = found[k];
    }
    return @BIG@_OK;
}
