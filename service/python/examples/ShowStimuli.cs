// Shows in a Unity scene what the server asks for: a quad that fills the field, a disk on it, or a
// checkerboard.
// Polls with unary calls, so that it runs on every platform with Grpc.Net.Client and the classes
// that protoc makes of proto/eyebox/v1. Attach it to an object with both renderers assigned, their
// materials unlit, and leave exposure, tonemapping and post-processing as they are measured.
using System;
using System.Collections;
using System.Threading.Tasks;
using Eyebox.V1;
using Grpc.Net.Client;
using UnityEngine;

public sealed class ShowStimuli : MonoBehaviour
{
    [SerializeField] private string address = "https://lab-server:50051";
    [SerializeField] private string job = "jobs/1";        // of run_plan or `eyebox`: a capture job
    [SerializeField] private Renderer field;               // fills the field of view
    [SerializeField] private Transform disk;               // of diameter 1 at its own scale
    [SerializeField] private Renderer diskRenderer;
    [SerializeField] private float diskDistance = 2;       // metres from the eye
    [SerializeField] private float fieldDistance = 2.1f;   // likewise; the quad is square to the eye
    [SerializeField] private int framesToSettle = 4;       // until the headset shows what is drawn

    private CaptureService.CaptureServiceClient client;

    private void Awake()
    {
        // A handler with the client's certificate belongs here: the server wants mutual TLS.
        client = new CaptureService.CaptureServiceClient(GrpcChannel.ForAddress(address));
    }

    private IEnumerator Start()
    {
        ulong shown = 0;
        while (true)
        {
            Task<StimulusStep> next = client.NextStimulusAsync(new NextStimulusRequest
                { Name = job, AfterStep = shown, TimeoutS = 20 }).ResponseAsync;
            yield return new WaitUntil(() => next.IsCompleted);
            if (next.IsFaulted)
            {
                Debug.LogWarning(next.Exception?.InnerException?.Message);
                yield return new WaitForSeconds(1);
                continue;
            }
            if (next.Result.Job.State >= JobState.Succeeded) yield break;
            if (next.Result.Step == 0) continue;           // nothing new yet
            Draw(next.Result.Capture.Stimulus);
            for (int frame = 0; frame < framesToSettle; ++frame) yield return new WaitForEndOfFrame();
            Task<AckShownReply> told = client.AckShownAsync(new AckShownRequest
                { Name = job, Step = next.Result.Step }).ResponseAsync;
            yield return new WaitUntil(() => told.IsCompleted);
            if (!told.IsFaulted) shown = next.Result.Step;
        }
    }

    private void Draw(Stimulus stimulus)
    {
        Color drive = stimulus.Drive == null ? Color.black
            : new Color((float)stimulus.Drive.Red, (float)stimulus.Drive.Green, (float)stimulus.Drive.Blue);
        bool bright = stimulus.Pattern == StimulusPattern.Disk;
        bool board = stimulus.Pattern == StimulusPattern.Checkerboard;
        bool whole = board || stimulus.Pattern == StimulusPattern.FullField;
        field.material.color = bright ? Color.black : drive;
        field.material.mainTexture = board ? Board(stimulus) : null;
        diskRenderer.enabled = !whole;
        if (whole) return;
        diskRenderer.material.color = bright ? drive : Color.black;
        float width = 2 * diskDistance * Mathf.Tan(0.5f * (float)stimulus.DiameterDeg * Mathf.Deg2Rad);
        disk.localScale = new Vector3(width, width, 1);
    }

    // Two by two texels, repeated over the quad: four squares meet in its middle, the one above it
    // to the left is white and takes the material's colour.
    private Texture2D Board(Stimulus stimulus)
    {
        var texture = new Texture2D(2, 2, TextureFormat.RGBA32, false, true)
            { filterMode = FilterMode.Point, wrapMode = TextureWrapMode.Repeat };
        texture.SetPixels(new[] { Color.black, Color.white, Color.white, Color.black }); // from below
        texture.Apply();
        float side = fieldDistance * Mathf.Tan((float)stimulus.DiameterDeg * Mathf.Deg2Rad);
        Vector2 pairs = (Vector2)field.transform.lossyScale / (2 * side);
        field.material.mainTextureScale = pairs;
        field.material.mainTextureOffset = new Vector2(0.5f, 0.5f) - pairs / 2;
        return texture;
    }
}
