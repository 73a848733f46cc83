% Measures a recording through a running `eyebox serve`, from MATLAB's own Python.
% Once: pyenv('Version', '/usr/bin/python3'); py.sys.path().append('service/python')

client = py.eyebox.connect('unix:eyebox.sock');
job = client.run(pyargs('recording', 'left_eye'));
while true
    state = string(job.wait(1));                       % returns after a second at the latest
    fprintf('%s\n', state);
    if ismember(state, ["SUCCEEDED", "FAILED", "CANCELLED"]), break, end
end

map = job.map('g');                                    % raises with the server's advice if it failed
g = double(map.value);                                 % [y, x], NaN where there is no value
sigma = double(map.sigma);
imagesc(g), axis image, colorbar, title("uniformity, unit " + string(map.unit))
fprintf('least g %.4f +- %.4f\n', min(g(:)), sigma(find(g == min(g(:)), 1)));
job.download('linearize.cube', 'linearize.cube');
client.close()
