// Values over time for the plots: the newest few minutes, in order of time.

const kKept_s = 330;
/** A value that is missing in so many rows is not known any more. */
const kNewest = 30;

export class Series {
  /** @type {(number | null | Date)[][]} rows: time, then the values */
  rows = [];

  /**
   * @param {number} wall_ms
   * @param {(number | null | undefined)[]} values what is not known leaves a gap
   */
  add(wall_ms, values) {
    const last = this.rows[this.rows.length - 1];
    // A clock that was set back begins again: dygraphs needs increasing times.
    if (last && wall_ms <= Number(last[0])) {
      if (Number(last[0]) - wall_ms < 1000) return;
      this.rows = [];
    }
    this.rows.push([new Date(wall_ms), ...values.map((value) => (Number.isFinite(value) ? /** @type {number} */ (value) : null))]);
    if (this.rows.length % 256 === 0) {
      const first = this.rows.findIndex((row) => Number(row[0]) > wall_ms - kKept_s * 1000);
      if (first > 0) this.rows.splice(0, first);
    }
  }

  /**
   * The newest value of each column that is known, of the last rows.
   * @returns {(number | null | Date)[]} as a row
   */
  newest() {
    const rows = this.rows.slice(-kNewest).reverse();
    return (rows[0] ?? []).map((_, column) => rows.find((row) => row[column] !== null)?.[column] ?? null);
  }

  /**
   * Least and greatest value since a time, with a margin, and at least `span` apart.
   * @param {number} from_ms
   * @param {number} span
   * @returns {[number, number]}
   */
  range(from_ms, span) {
    let [least, most] = [Infinity, -Infinity];
    for (let i = this.rows.length - 1; i >= 0 && Number(this.rows[i][0]) >= from_ms; --i) {
      for (let k = 1; k < this.rows[i].length; ++k) {
        const value = this.rows[i][k];
        if (value === null) continue;
        least = Math.min(least, Number(value));
        most = Math.max(most, Number(value));
      }
    }
    if (least > most) return [0, span];
    const missing = Math.max(0, span - (most - least)) / 2;
    const margin = 0.06 * Math.max(span, most - least);
    return [least - missing - margin, most + missing + margin];
  }

  /**
   * The row at this time: the first that is not earlier.
   * @param {number} wall_ms
   * @returns {(number | null | Date)[] | undefined} undefined: all are earlier
   */
  at(wall_ms) {
    let [low, high] = [0, this.rows.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (Number(this.rows[middle][0]) < wall_ms) low = middle + 1;
      else high = middle;
    }
    return this.rows[low];
  }
}
