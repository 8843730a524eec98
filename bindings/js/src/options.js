// SPDX-License-Identifier: MIT
// Options as callers give them: what an option cannot be is InvalidInput with its name.

/** A mesh or an option that no bound can be given for; `message` says what and where. */
export class InvalidInput extends Error {}

/** Refuses options that are not among `names`: one that is spelled wrongly would go unnoticed. */
export function requireKnown(options, names) {
  if (typeof options !== 'object' || options === null) throw new InvalidInput('options must be an object');
  const unknown = Object.keys(options).find((name) => !names.includes(name));
  if (unknown !== undefined)
    throw new InvalidInput(`there is no option ${unknown}: the options are ${names.join(', ')}`);
}

/** The number of an option; where it is left out, `none`, which the engine takes for no value. */
export function number(options, name, none, isValid, description) {
  const value = options[name];
  if (value === undefined || value === null) return none;
  if (typeof value === 'number' && isValid(value)) return value;
  throw new InvalidInput(`${name} must be ${description}, not ${String(value)}`);
}

export const isNotNegative = (x) => x >= 0;

/** A length; where it is left out, -1. */
export const length = (options, name) => number(options, name, -1, isNotNegative, 'a length of 0 or more');

/** The tolerance, which cannot be left out. */
export function requiredTolerance(options) {
  const tolerance = length(options, 'tolerance');
  if (tolerance < 0) throw new InvalidInput('tolerance must be given: a length of 0 or more');
  return tolerance;
}

export const timeLimitOf = (options) => number(options, 'timeLimit', Infinity, isNotNegative, 'seconds, 0 or more');

/** 1 or 0 for true and false; 0 where it is left out. */
export function flag(options, name) {
  const value = options[name] ?? false;
  if (typeof value !== 'boolean') throw new InvalidInput(`${name} must be true or false, not ${String(value)}`);
  return value ? 1 : 0;
}

/** 0 or 1 for the first and the second of two words; 0 where it is left out. */
export function chosen(options, name, words) {
  const word = options[name] ?? words[0];
  if (!words.includes(word)) throw new InvalidInput(`${name} must be one of: ${words.join(', ')}`);
  return word === words[1] ? 1 : 0;
}

/** An array, or something that is indexed like one; where it is left out, null. */
export function arrayLike(options, name) {
  const value = options[name] ?? null;
  if (value !== null && (typeof value !== 'object' || !Number.isInteger(value.length)))
    throw new InvalidInput(`${name} must be an array, not ${String(value)}`);
  return value;
}

/** The smaller tolerances of a simplification, from anything that can be iterated over. */
export function levelsOf(options) {
  const levels = options.levels ?? [];
  const isLength = (x) => typeof x === 'number' && x >= 0;
  if (typeof levels !== 'object' || typeof levels[Symbol.iterator] !== 'function')
    throw new InvalidInput(`levels must be lengths, such as [0.1, 0.2], not ${String(levels)}`);
  const values = [...levels];
  if (!values.every(isLength)) throw new InvalidInput('levels must be lengths of 0 or more');
  return Float64Array.from(values);
}

export function requireStride(stride) {
  if (!Number.isInteger(stride) || stride < 3) throw new InvalidInput('stride must be a whole number, 3 or more');
}
