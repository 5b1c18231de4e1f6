// Reads a recording with the reader of the MCAP project, by its index and from its beginning, with all checks,
// and holds each message against its schema. Prints how many messages each topic has.
//   node read_recording.mjs RUN.mcap [--cut]      --cut: the file has no end
import { open } from "node:fs/promises";
import { readFileSync } from "node:fs";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";

const [path, cut] = process.argv.slice(2);
const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };

function refuse(where, why) {
  throw new Error(`${where}: ${why}`);
}

/** The value is of the schema's type, and everything in it that is required is there. */
function check(value, schema, where) {
  const fits = {
    object: () => typeof value === "object" && value !== null && !Array.isArray(value),
    array: () => Array.isArray(value),
    integer: () => Number.isInteger(value),
    number: () => typeof value === "number" && Number.isFinite(value),
    string: () => typeof value === "string" && (!schema.enum || schema.enum.includes(value)),
    boolean: () => typeof value === "boolean",
  }[schema.type];
  if (!fits) refuse(where, `a type that viewers do not know: ${JSON.stringify(schema.type)}`);
  if (!fits()) refuse(where, `${JSON.stringify(value)} is no ${schema.type}`);
  if (schema.type === "array") value.forEach((element, i) => check(element, schema.items, `${where}[${i}]`));
  if (schema.type !== "object" || where.endsWith(".not_finite")) return;
  for (const name of schema.required ?? []) if (!(name in value)) refuse(where, `no ${name}`);
  for (const [name, member] of Object.entries(value)) {
    if (!(name in schema.properties)) refuse(where, `${name} is not in the schema`);
    check(member, schema.properties[name], `${where}.${name}`);
  }
}

class Counter {
  counts = {};
  last = {};
  decoder = new TextDecoder("utf-8", { fatal: true });

  take(message, channel, schema) {
    const { topic } = channel;
    if (channel.messageEncoding !== "json" || schema.encoding !== "jsonschema") refuse(topic, "no JSON");
    const value = JSON.parse(this.decoder.decode(message.data));
    check(value, JSON.parse(this.decoder.decode(schema.data)), topic);
    if (message.sequence !== (this.counts[topic] ?? 0)) refuse(topic, `sequence ${message.sequence}`);
    this.counts[topic] = (this.counts[topic] ?? 0) + 1;
    this.last[topic] = value;
  }
}

async function readByIndex() {
  const file = await open(path);
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      await file.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const counter = new Counter();
  let before = 0n;
  const sequences = {};
  for await (const message of reader.readMessages()) {
    if (message.logTime < before) refuse(path, "the index is not in order of time");
    before = message.logTime;
    const channel = reader.channelsById.get(message.channelId);
    // Records of one topic may have been written out of order; a message counts where it stands.
    sequences[channel.topic] = (sequences[channel.topic] ?? 0) + 1;
    counter.counts[channel.topic] = message.sequence;
    counter.take(message, channel, reader.schemasById.get(channel.schemaId));
  }
  await file.close();
  if (reader.statistics.messageCount !== BigInt(Object.values(sequences).reduce((a, b) => a + b, 0)))
    refuse(path, "the statistics have another number of messages");
  return sequences;
}

function readFromTheBeginning() {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(readFileSync(path));
  const channels = new Map();
  const schemas = new Map();
  const counter = new Counter();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type !== "Message") continue;
    const channel = channels.get(record.channelId);
    counter.take(record, channel, schemas.get(channel.schemaId));
  }
  if (reader.done() === Boolean(cut)) refuse(path, cut ? "it has an end" : "it has no end");
  return counter.counts;
}

const counts = readFromTheBeginning();
if (!cut) {
  const indexed = await readByIndex();
  for (const topic of new Set([...Object.keys(counts), ...Object.keys(indexed)]))
    if (counts[topic] !== indexed[topic]) refuse(topic, `${counts[topic]} messages, ${indexed[topic]} by the index`);
}
console.log(JSON.stringify(counts));
