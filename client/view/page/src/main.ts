// The page: puts its parts together, and keeps them up with what is shown.
import './style.css';
import { Vector3 } from 'three';
import { Event_Kind } from './gen/haptic/v1/telemetry_pb';
import { WorkerTransport } from './connection/worker_transport';
import { Charts } from './charts/charts';
import { Hands } from './grab/hands';
import { listen, makeHelp, type Key } from './keyboard';
import { frictionRatios } from './model/friction';
import type { Moment } from './model/moment';
import { Player } from './model/player';
import type { Source } from './model/source';
import { Banners } from './panels/banners';
import { DevicesPanel } from './panels/devices';
import { h, setClass, setText, time as timeText } from './panels/dom';
import { FaultsPanel } from './panels/faults';
import { Header } from './panels/header';
import { LookPanel } from './panels/look';
import { SelectionPanel } from './panels/selection';
import { fingersOf } from './scene/fingers';
import { initialLook, SceneView, type Selection } from './scene/view';
import { Session } from './session';
import { currentTheme, startTheme, toggleTheme } from './theme';
import { Timeline } from './timeline/timeline';
import { inspectable } from './inspect';

const PANELS_PERIOD = 100; // ms between two updates of numbers and charts
const NEVER = BigInt(-1);

/** `token`: of a driver, for the gateway; `quality=full`: pictures never get coarser, however slow they are. */
const parameters = new URLSearchParams(location.search);

function socketUrl(): string {
  const url = new URL('ws', location.href);
  url.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
  url.hash = '';
  const token = parameters.get('token');
  url.search = token === null ? '' : `?token=${encodeURIComponent(token)}`;
  return url.href;
}

startTheme(() => paint());

const canvas = h('canvas', { id: 'scene', tabindex: '0', 'aria-label': 'The scene in three dimensions' });
const empty = h('p', { class: 'empty-scene', hidden: true });
const floorText = h('span', { class: 'num' });
const stageArea = h('section', { class: 'stage', 'aria-label': 'Scene' }, canvas, empty);
document.body.append(stageArea); // the picture's size is known from here on
const view = new SceneView(canvas, { ...initialLook }, parameters.get('quality') !== 'full');

let selection: Selection;
const transport = new WorkerTransport();
const banners = new Banners(() => void session.clearFault());
const session = new Session(transport, socketUrl(), {
  connection: (state, text) => {
    connectionState = state;
    connectionText = text;
    banners.showLost(state === 'down' && player.source.live ? text : undefined);
    if (state === 'down') hands.forget();
    tellConnection();
  },
  status: () => {
    banners.showFaults(session.status?.fault ?? [], session.mayDrive);
    hands.mayDrive = session.mayDrive;
    devicesPanel.setStatuses(player.source.live ? session.statuses : []);
    tellConnection();
  },
  devices: () => {
    if (player.source.live) useSource();
  },
  scene: () => {
    if (player.source.live) useSource();
  },
  faults: () => faultsPanel.show(session.faults),
  wrong: (text) => banners.note(text, 'wrong'),
  happened: (event) => {
    // the number in the header and the marks tell of missed ticks; faults have banners
    if (event.kind !== Event_Kind.TICKS_MISSED && event.kind !== Event_Kind.FAULT_LATCHED) banners.note(event.message);
  },
});
const livePlayer = new Player(session.source);
let player = livePlayer;
let connectionState: 'up' | 'down' | 'connecting' = 'connecting';
let connectionText = '';
let shownRevision = NEVER;
let shownScene = '';

const hands = new Hands(view, transport, (picked) => select(picked));
const timeline = new Timeline(player);
const charts = new Charts(player);
const devicesPanel = new DevicesPanel({
  select: (device) => {
    const name = player.source.devices[device]?.name;
    const finger = fingersOf_().findIndex((span) => span.device === name);
    if (finger >= 0) select({ kind: 'finger', index: finger });
  },
  hand: (device) => hands.putBeside(device),
});
const selectionPanel = new SelectionPanel((picked) => select(picked));
const faultsPanel = new FaultsPanel();
const lookPanel = new LookPanel(view.look, () => view.applyLook(selection));
const header = new Header({
  arm: () => void session.arm(),
  disarm: () => void session.disarm(),
  stop: () => void session.stop(),
  theme: () => {
    toggleTheme();
    paint();
  },
  help: () => help.showModal(),
  open: () => fileInput.click(),
  live: () => usePlayer(livePlayer),
});
const fileInput = h('input', { type: 'file', accept: '.mcap', hidden: true, id: 'file' });
const pauseButton = h('button', { class: 'small', onclick: () => void session.pauseOrResume() }, 'Pause simulation');
const simulation = h(
  'div',
  { class: 'line simulation' },
  pauseButton,
  h('button', { class: 'small', onclick: () => void session.step(1) }, '1 tick'),
  h('button', { class: 'small', onclick: () => void session.step(100) }, '100 ticks'),
  h('button', { class: 'small', onclick: () => void session.resetScene(), title: 'All objects back to where the scene begins' }, 'Reset scene'),
);

function panel(title: string, open: boolean, ...children: Node[]): HTMLDetailsElement {
  return h('details', { open, class: 'panel' }, h('summary', {}, title), ...children);
}

const keys: Key[] = [
  { key: 's', shown: 'S', does: 'emergency stop', run: () => session.mayDrive && void session.stop() },
  { key: 'a', shown: 'A', does: 'arm: allow force', run: () => session.mayDrive && void session.arm() },
  { key: 'd', shown: 'D', does: 'disarm', run: () => session.mayDrive && void session.disarm() },
  { key: ' ', shown: 'Space', does: 'pause the picture; again: back to now', run: () => player.toggle() },
  { key: 'arrowleft', shown: '←', does: 'the moment before', run: () => player.step(-1) },
  { key: 'arrowright', shown: '→', does: 'the moment after', run: () => player.step(1) },
  { key: 'c', shown: 'C', does: 'cells', run: () => changeLook(() => (view.look.shown = !view.look.shown)) },
  { key: 'f', shown: 'F', does: 'force arrows', run: () => changeLook(toggleForces) },
  { key: 'h', shown: 'H', does: 'HIPs and proxies', run: () => changeLook(() => (view.look.hips = view.look.proxies = !view.look.hips)) },
  { key: 'r', shown: 'R', does: 'view from where it began', run: () => view.stage.resetCamera() },
  { key: '1', shown: '1', does: 'view from the front', run: () => view.stage.resetCamera(new Vector3(0, 0.12, 1)) },
  { key: '2', shown: '2', does: 'view from the right', run: () => view.stage.resetCamera(new Vector3(1, 0.12, 0)) },
  { key: '3', shown: '3', does: 'view from above', run: () => view.stage.resetCamera(new Vector3(0, 1, 0.001)) },
  { key: 'o', shown: 'O', does: 'open a recording', run: () => fileInput.click() },
  { key: 't', shown: 'T', does: 'light or dark', run: () => { toggleTheme(); paint(); } },
  { key: 'escape', shown: 'Esc', does: 'select nothing', run: () => select(undefined) },
  { key: '?', shown: '?', does: 'this list', run: () => (help.open ? help.close() : help.showModal()) },
];
const help = makeHelp(keys);

const dropHint = h('div', { class: 'drop', hidden: true }, 'Drop a recording (.mcap) to open it');
const reading = h('progress', { max: '1', value: '0', hidden: true, 'aria-label': 'Reading the recording' });
stageArea.append(
  lookPanel.legend,
  h('div', { class: 'scales' }, h('span', {}, 'grid ', floorText), h('span', { class: 'swatch force' }), lookPanel.scaleText),
  reading,
);
document.body.prepend(header.root, banners.root);
document.body.append(
  h(
    'aside',
    { class: 'side', 'aria-label': 'Numbers' },
    panel('Devices', true, devicesPanel.list),
    panel('Charts', true, charts.root),
    panel('Selection', true, selectionPanel.root),
    panel('View', false, lookPanel.root),
    panel('Simulation', false, simulation),
    panel('Faults', false, faultsPanel.list),
  ),
  timeline.root,
  fileInput,
  help,
  dropHint,
);

function fingersOf_() {
  const moment = player.moment;
  const scene = player.source.scenes.get(moment?.revision ?? NEVER);
  return scene ? fingersOf(scene) : [];
}

function toggleForces(): void {
  const on = !view.look.hipForces;
  view.look.hipForces = on;
  view.look.deviceForces = on;
}

function changeLook(change: () => void): void {
  change();
  lookPanel.refresh();
  view.applyLook(selection);
}

function select(picked: Selection): void {
  selection = picked;
  selectionPanel.select(picked);
  view.applyLook(picked);
}

function tellConnection(): void {
  if (!player.source.live) {
    header.connected('file', player.source.name);
  } else {
    header.connected(connectionState, connectionState === 'up' ? 'live' : connectionState === 'down' ? 'lost' : 'connecting');
  }
  setClass(document.body, 'stale', player.source.live && connectionState !== 'up');
  const { status } = session;
  pauseButton.textContent = status?.paused ? 'Resume simulation' : 'Pause simulation';
  for (const button of simulation.querySelectorAll('button')) button.disabled = !session.mayDrive || !player.source.live;
}

function usePlayer(next: Player): void {
  player = next;
  timeline.setPlayer(next);
  charts.setPlayer(next);
  hands.live = next.source.live;
  devicesPanel.setStatuses(next.source.live ? session.statuses : []); // a recording does not tell them
  shownRevision = NEVER;
  banners.showLost(connectionState === 'down' && next.source.live ? connectionText : undefined);
  tellConnection();
  useSource();
}

/** Puts the scene of the shown moment on the stage, if it is not there. */
function useSource(): void {
  const { source } = player;
  const revision = player.moment?.revision ?? session.scene?.revision ?? NEVER;
  const scene = source.scenes.get(revision) ?? (source.live ? session.scene : [...source.scenes.values()][0]);
  const mayDrive = session.mayDrive && source.live;
  const key = `${source.name}/${scene?.scene?.name}`;
  const keepCamera = key === shownScene && view.objects !== undefined;
  shownScene = key;
  shownRevision = scene?.revision ?? NEVER;
  view.setScene(scene, source.devices, keepCamera);
  select(undefined);
  lookPanel.refresh();
  const grid = view.stage.gridStep;
  setText(floorText, grid < 0.1 ? `${Number((1000 * grid).toPrecision(2))} mm` : `${Number(grid.toPrecision(2))} m`);
  hands.setScene(source.live ? scene : undefined, source.devices);
  devicesPanel.setDevices(source.devices, mayDrive);
  selectionPanel.setScene(scene);
  const fingers = scene ? fingersOf(scene) : [];
  const ratios = new WeakMap<Moment, number[]>();
  charts.setInput({
    devices: source.devices.map((device) => device.name),
    fingers: fingers.map((finger) => finger.name),
    friction: (moment) => {
      let told = ratios.get(moment);
      if (!told) {
        const { objects } = view;
        if (!objects || moment.revision !== shownRevision || !moment.objects) return [];
        objects.place(moment.objects);
        told = frictionRatios(moment, fingers, objects);
        ratios.set(moment, told);
        if (player.moment?.objects) objects.place(player.moment.objects);
      }
      return told;
    },
  });
  const objects = scene?.object.length ?? 0;
  empty.hidden = objects > 0 || scene === undefined;
  setText(empty, 'The scene is empty: load one with hapticctl scene load, or add objects.');
}

function paint(): void {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string): string => style.getPropertyValue(name).trim();
  view.stage.colour(colour('--stage'), colour('--grid'), currentTheme() === 'dark');
  charts.rebuild();
}

async function openFile(file: File): Promise<void> {
  reading.hidden = false;
  reading.value = 0;
  try {
    const { openRecording } = await import('./recording/open');
    const source: Source = await openRecording(file, file.name, (share) => {
      reading.value = share;
    });
    usePlayer(new Player(source));
  } catch (error) {
    banners.note(error instanceof Error ? error.message : String(error), 'wrong');
  } finally {
    reading.hidden = true;
    fileInput.value = '';
  }
}

fileInput.addEventListener('change', () => {
  const file = fileInput.files?.[0];
  if (file) void openFile(file);
});
window.addEventListener('dragover', (event) => {
  event.preventDefault();
  dropHint.hidden = false;
});
window.addEventListener('dragleave', (event) => {
  if (event.relatedTarget === null) dropHint.hidden = true;
});
window.addEventListener('drop', (event) => {
  event.preventDefault();
  dropHint.hidden = true;
  const file = event.dataTransfer?.files[0];
  if (file) void openFile(file);
});
// a hand that nobody tells of any more is a fault while force is allowed
window.addEventListener('pagehide', () => {
  if (hands.holding && session.armed) void session.disarm();
});

let lastPicture = performance.now();
let lastPanels = 0;

function updatePanels(moment: Moment | undefined): void {
  const { status } = session;
  const live = player.source.live;
  const armed = live ? (connectionState === 'up' ? session.armed : undefined) : moment?.armed;
  header.force(armed, session.mayDrive, live);
  const scene = player.source.scenes.get(shownRevision)?.scene?.name ?? '';
  const pace = player.source.paces.newest;
  const paused = moment?.paused ? 'simulation paused · ' : '';
  const ticks = live && status ? `${paused}${status.rateHz.toFixed(0)} Hz · wake-up ${timeText(pace?.wakeupMean ?? Number.NaN)} · ${status.missedTicks} missed` : paused;
  header.tell(scene, ticks);
  devicesPanel.update(moment);
  selectionPanel.update(moment, selection);
  timeline.update();
  charts.update();
}

function picture(now: number): void {
  player.advance((now - lastPicture) / 1000);
  lastPicture = now;
  const { moment } = player;
  if (moment && moment.revision !== shownRevision && player.source.scenes.has(moment.revision)) useSource();
  view.show(moment);
  if (moment && player.source.live) hands.draw(moment);
  view.stage.render();
  if (now - lastPanels > PANELS_PERIOD) {
    lastPanels = now;
    updatePanels(moment);
  }
  requestAnimationFrame(picture);
}

listen(keys);
paint();
useSource();
session.connect();
requestAnimationFrame(picture);
Object.assign(window, { hapticView: inspectable(view, session, () => player) });
